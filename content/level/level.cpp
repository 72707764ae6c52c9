#include "content/level/level.h"

#include <algorithm>

namespace pliant {

bool LevelNode::has_pliant() const {
  return deformable || probe || device || soft_body || handle || rigid_body || motion || effect || joint;
}

bool Level::has_pliant() const {
  return environment ||
         std::any_of(nodes.begin(), nodes.end(), [](const LevelNode& node) { return node.has_pliant(); });
}

std::vector<dmat4> world_matrices(const std::vector<LevelNode>& nodes) {
  std::vector<dmat4> world;
  world.reserve(nodes.size());
  for (const LevelNode& node : nodes) {
    dmat4 m = glm::mat4_cast(dquat(node.local.rotation));
    for (int c = 0; c < 3; ++c) m[c] *= static_cast<double>(node.local.scale[c]);
    m[3] = glm::dvec4(dvec3(node.local.translation), 1.0);
    world.push_back(node.parent < 0 ? m : world[static_cast<std::size_t>(node.parent)] * m);
  }
  return world;
}

bool has_area(const LevelMesh& mesh, const dmat3& frame) {
  for (const Primitive& p : mesh.primitives)
    for (std::size_t t = 0; t + 2 < p.index.size(); t += 3) {
      const dvec3 a(p.position[p.index[t]]);
      const dvec3 b = frame * (dvec3(p.position[p.index[t + 1]]) - a),
                  c = frame * (dvec3(p.position[p.index[t + 2]]) - a);
      if (cross(b, c) != dvec3(0)) return true;
    }
  return false;
}

void make_touchable(Level& level) {
  std::vector<dmat3> frame;  // per node; parents come before children
  for (LevelNode& node : level.nodes) {
    dmat3 own = glm::mat3_cast(dquat(node.local.rotation));
    for (int i = 0; i < 3; ++i) own[i] *= static_cast<double>(node.local.scale[i]);
    frame.push_back(node.parent < 0 ? own : frame[static_cast<std::size_t>(node.parent)] * own);
    if (node.in_scene && node.mesh >= 0 && !node.deformable &&
        has_area(level.meshes[static_cast<std::size_t>(node.mesh)], frame.back()))
      node.deformable = Deformable{};
  }
}

}  // namespace pliant
