// The surface of tetrahedra: their faces that no other shares.
#pragma once

#include <span>
#include <vector>

#include "components/tet_mesh.h"

namespace pliant {

// Nodes of each face, counter-clockwise seen from outside, in the order of the tetrahedra.
std::vector<uvec3> boundary_triangles(std::span<const Tet> tets);

}  // namespace pliant
