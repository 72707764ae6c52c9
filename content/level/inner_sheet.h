// The inner sheet of a thin wall whose cavity is filled: it lies in the middle of tissue, a hair's breadth from the
// outer one. Nobody can touch or see it, and as part of what collides it would meet the outer sheet everywhere.
#pragma once

#include <vector>

#include "components/tet_mesh.h"
#include "content/mesh/mesh_build.h"

namespace pliant {

// Of each triangle: whether tissue covers it: a third of a cell off its outer side there still is some.
std::vector<std::uint8_t> covered_triangles(const Mesh& mesh, const TetMesh& tissue);

// Takes those triangles out of `primitives`. `surface` is what was built of them. Says whether there were any.
bool leave_out_covered(const BuiltMesh& surface, const TetMesh& tissue, std::vector<Primitive>& primitives);

}  // namespace pliant
