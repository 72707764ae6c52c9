// Hollows of a soft body that have a pressure (Cavity): the closed inner surfaces of its tetrahedra.
#pragma once

#include "content/level/spawn_soft.h"

namespace pliant {

// Sets TetMesh::cavities of the body of `node`. `to_object`: the world to the body's frame; `world`: each node's frame.
// Errors: no hollow, none in the mesh that a cavity names, or no such mesh.
Status set_cavities(const Level& level, const LevelNode& node, const dmat4& to_object, const std::vector<dmat4>& world,
                    SoftParts& parts);

}  // namespace pliant
