// Border vertices that lie on one another but for rounding: both ends of a seam, the ring about a pole.
#pragma once

#include "content/mesh/mesh_weld.h"

namespace pliant {

// Moves border vertices that are nearer than 2^-20 of the object's extent to one position, that of the first; weld()
// then merges them. Returns how many moved. Vertices that are not on a border keep their place, so that closed parts
// with a crack between them stay two.
std::uint32_t join_borders(const Mesh& mesh, const Welded& welded, Gathered& gathered);

}  // namespace pliant
