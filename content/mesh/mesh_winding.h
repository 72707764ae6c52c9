// Which side of a surface is outside, where the file says it wrongly. Triangles that run against their neighbours are
// turned to agree with the larger area. A closed part that is inside out is turned, unless it is the wall of a cavity
// in another part. An open part is turned where the file's own normals all say so. What cannot be decided stays as it
// is and is counted.
#pragma once

#include <span>
#include <vector>

#include "content/mesh/mesh_surface.h"
#include "content/mesh/mesh_weld.h"

namespace pliant {

// The triangles of `mesh` to turn over, as a flag each; empty where there is none. `against`: from connect_triangles.
// Marks in `gathered` whose normals point inward together with their winding.
std::vector<std::uint8_t> find_wrong_winding(std::span<const Primitive> primitives, const mat4& to_object,
                                             const Welded& welded, const std::vector<SideAgainst>& against,
                                             const Mesh& mesh, Gathered& gathered, MeshReport& report);

// Turns them in the touch mesh and in what is drawn. `across` must be found anew.
void turn_over(const std::vector<std::uint8_t>& turned, Mesh& mesh, Welded& welded, Gathered& gathered);

}  // namespace pliant
