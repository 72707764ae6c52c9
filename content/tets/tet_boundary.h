// The surface of tetrahedra: the unshared faces.
#pragma once

#include <span>
#include <vector>

#include "components/tet_mesh.h"

namespace pliant {

struct TetFace {
  std::array<std::uint32_t, 3> nodes;  // ascending
  std::uint32_t number;                // 4 * tetrahedron + the opposite corner
};
// All faces of all tetrahedra; the two copies of a shared face are adjacent.
std::vector<TetFace> sorted_faces(std::span<const Tet> tets);

// Nodes of each unshared face, counter-clockwise from outside, in the order of the tetrahedra.
std::vector<uvec3> boundary_triangles(std::span<const Tet> tets);

}  // namespace pliant
