// The inner sheet of a thin wall whose cavity is filled. It lies inside the tissue, close to the outer sheet. It can be
// neither touched nor seen, and as part of the collision mesh it would touch the outer sheet everywhere.
#pragma once

#include <vector>

#include "content/mesh/mesh_build.h"

namespace pliant {

struct InnerSheet {
  double wall = 0.0;                // [m] thickness; 0: not a thin wall, no triangle is inner
  std::vector<std::uint8_t> inner;  // per triangle: a point half a wall thickness outside of it lies in the cavity
};
InnerSheet find_inner_sheet(const Mesh& mesh);

// Removes the inner triangles from `primitives`, from which the mesh was built. Returns whether there were any.
bool leave_out(const InnerSheet& sheet, const Mesh& mesh, std::vector<Primitive>& primitives);

}  // namespace pliant
