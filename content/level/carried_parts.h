// Meshes that are only drawn and lie inside of something that deforms: an organ's vessels, a lump, the inner sheet of
// its capsule. They go with it (Carries), or are left behind where they stand.
#pragma once

#include <string>
#include <vector>

#include "components/soft_body.h"
#include "content/level/level.h"
#include "content/mesh/mesh_build.h"

namespace pliant {

// Nodes in the scene whose mesh is only drawn and lies, by more than half of its vertices, inside of a node's surface,
// or which hang below that node. `surface`: the node's, in its object frame; `to_object`: world to that frame.
std::vector<std::int32_t> find_parts(const Level& level, std::int32_t node, const Mesh& surface, const dmat4& to_object,
                                     Fill fill = Fill::kSolid);

// "`vessels`, `lump` and 2 more"
std::string names_of(const Level& level, const std::vector<std::int32_t>& nodes);

// How a part rides on tetrahedra. Vertices outside of them keep their place beside the nearest one's corner.
void embed_part(const Mesh& part, const TetMesh& tets, CarriedPart& out);

// Gives every drawn vertex the touch vertex of the surface that is nearest, and the share [1] of its dent: 1 at the
// surface, 0 from `depth` [m] on.
std::vector<float> dent_shares(DrawMesh& part, const Mesh& surface, double depth);

}  // namespace pliant
