// The inner sheet of a thin wall whose cavity is filled: it lies in the middle of tissue, a hair's breadth from the
// outer one. Nobody can touch or see it, and as part of what collides it would meet the outer sheet everywhere.
#pragma once

#include <vector>

#include "components/tet_mesh.h"
#include "content/mesh/mesh_build.h"

namespace pliant {

// Takes the triangles out of `primitives` that tissue covers: a third of a cell off their outer side there still is
// some. `surface` is what was built of them. Says whether there were any.
bool leave_out_covered(const BuiltMesh& surface, const TetMesh& tissue, std::vector<Primitive>& primitives);

}  // namespace pliant
