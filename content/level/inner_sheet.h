// The inner sheet of a thin wall whose cavity is filled: it lies in the middle of tissue, a hair's breadth from the
// outer one. Nobody can touch or see it, and as part of what collides it would meet the outer sheet everywhere.
#pragma once

#include <vector>

#include "content/mesh/mesh_build.h"

namespace pliant {

struct InnerSheet {
  double wall = 0.0;                // [m] thickness; 0: the mesh is no thin wall, and nothing is inner
  std::vector<std::uint8_t> inner;  // of each triangle: half a wall off its outer side there is the cavity
};
InnerSheet find_inner_sheet(const Mesh& mesh);

// Takes those triangles out of `primitives`, of which the mesh was built. Says whether there were any.
bool leave_out(const InnerSheet& sheet, const Mesh& mesh, std::vector<Primitive>& primitives);

}  // namespace pliant
