// The surface of tetrahedra: their faces that no other shares.
#pragma once

#include <span>
#include <vector>

#include "components/tet_mesh.h"

namespace pliant {

struct TetFace {
  std::array<std::uint32_t, 3> nodes;  // ascending
  std::uint32_t number;                // 4 * tetrahedron + the corner over against it
};
// Every face of every tetrahedron; those that two share stand side by side.
std::vector<TetFace> sorted_faces(std::span<const Tet> tets);

// Nodes of each face that stands alone, counter-clockwise seen from outside, in the order of the tetrahedra.
std::vector<uvec3> boundary_triangles(std::span<const Tet> tets);

}  // namespace pliant
