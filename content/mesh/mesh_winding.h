// Corrects wrong winding. Triangles opposite to their neighbours are turned to agree with the larger area. A closed
// part that is inside out is turned, unless it is the wall of a cavity in another part. An open part is turned if all
// of the file's normals say so. Undecidable parts are kept and counted.
#pragma once

#include <span>
#include <vector>

#include "content/mesh/mesh_surface.h"
#include "content/mesh/mesh_weld.h"

namespace pliant {

// Flags the triangles of `mesh` to turn; empty if there are none. `against`: from connect_triangles. Marks in
// `gathered` the normals that point inward together with their winding.
std::vector<std::uint8_t> find_wrong_winding(std::span<const Primitive> primitives, const mat4& to_object,
                                             const Welded& welded, const std::vector<SideAgainst>& against,
                                             const Mesh& mesh, Gathered& gathered, MeshReport& report);

// Turns them in the touch mesh and the drawn triangles. `across` must be recomputed.
void turn_over(const std::vector<std::uint8_t>& turned, Mesh& mesh, Welded& welded, Gathered& gathered);

}  // namespace pliant
