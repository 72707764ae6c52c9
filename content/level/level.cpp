#include "content/level/level.h"

namespace pliant {

bool Level::has_pliant() const {
  if (environment) return true;
  for (const LevelNode& node : nodes)
    if (node.deformable || node.probe || node.device || node.soft_body || node.handle || node.rigid_body || node.motion)
      return true;
  return false;
}

void make_touchable(Level& level) {
  for (LevelNode& node : level.nodes)
    if (node.in_scene && node.mesh >= 0 && !level.meshes[static_cast<std::size_t>(node.mesh)].primitives.empty() &&
        !node.deformable)
      node.deformable = Deformable{};
}

}  // namespace pliant
