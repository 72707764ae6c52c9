// Meshes that are only drawn and lie inside a deformable object: an organ's vessels, a lump, the inner sheet of its
// capsule. They deform with it (Carries), or stay fixed.
#pragma once

#include <string>
#include <vector>

#include "components/soft_body.h"
#include "content/level/level.h"
#include "content/mesh/mesh_build.h"

namespace pliant {

// Nodes in the scene that are only drawn, and lie inside the node's surface with more than half of their vertices or
// are below that node. `surface`: the node's, in its object frame; `to_object`: world to that frame.
std::vector<std::int32_t> find_parts(const Level& level, std::int32_t node, const Mesh& surface, const dmat4& to_object,
                                     Fill fill = Fill::kSolid);

// "`vessels`, `lump` and 2 more"
std::string names_of(const Level& level, const std::vector<std::int32_t>& nodes);

// Embeds a part's vertices in tetrahedra. Vertices outside keep their offset from the nearest tetrahedron's corner.
void embed_part(const Mesh& part, const TetMesh& tets, CarriedPart& out);

// Assigns to each drawn vertex the nearest touch vertex of the surface, and the share [1] of its dent that it follows:
// 1 at the surface, 0 from `depth` [m] on.
std::vector<float> dent_shares(DrawMesh& part, const Mesh& surface, double depth);

}  // namespace pliant
