#include "editor/viewport/frames.h"

#include <unordered_map>
#include <unordered_set>

namespace pliant {
namespace {

dmat4 matrix_of(const LocalTransform& local) {
  dmat4 m = glm::mat4_cast(dquat(local.rotation));
  for (int c = 0; c < 3; ++c) m[c] *= static_cast<double>(local.scale[c]);
  m[3] = glm::dvec4(dvec3(local.translation), 1.0);
  return m;
}

}  // namespace

std::vector<dmat4> world_frames(const State& state) {
  std::vector<dmat4> frames;
  frames.reserve(state.nodes.size());
  std::unordered_map<NodeId, std::size_t> place;
  place.reserve(state.nodes.size());
  for (const auto& each : state.nodes) {
    const auto parent = place.find(each->parent);
    place[each->id] = frames.size();
    const dmat4 m = matrix_of(each->node.local);
    frames.push_back(parent == place.end() ? m : frames[parent->second] * m);
  }
  return frames;
}

std::vector<bool> at_or_below(const State& state, std::span<const NodeId> ids) {
  std::vector<bool> found(state.nodes.size(), false);
  if (ids.empty()) return found;
  std::unordered_set<NodeId> in(ids.begin(), ids.end());
  in.erase(kNoNode);
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    const DocumentNode& node = *state.nodes[i];
    if (!in.contains(node.id) && !in.contains(node.parent)) continue;
    in.insert(node.id);
    found[i] = true;
  }
  return found;
}

std::vector<bool> shown_nodes(const State& state, std::span<const NodeId> isolated) {
  std::vector<bool> shown =
      isolated.empty() ? std::vector<bool>(state.nodes.size(), true) : at_or_below(state, isolated);
  for (std::size_t i = 0; i < shown.size(); ++i) shown[i] = shown[i] && state.nodes[i]->node.in_scene;
  return shown;
}

std::vector<NodeId> topmost_of(const State& state, std::span<const NodeId> ids) {
  std::vector<NodeId> top;
  const std::unordered_set<NodeId> wanted(ids.begin(), ids.end());
  std::unordered_set<NodeId> in;  // wanted or below one
  for (const auto& each : state.nodes) {
    if (in.contains(each->parent)) {
      in.insert(each->id);
    } else if (wanted.contains(each->id)) {
      in.insert(each->id);
      top.push_back(each->id);
    }
  }
  return top;
}

Box bounds_of(const State& state, std::size_t node, const dmat4& frame) {
  Box box;
  const std::int32_t mesh = state.nodes[node]->node.mesh;
  if (mesh < 0) return box;
  const Box& of = state.meshes[static_cast<std::size_t>(mesh)]->box;
  if (of.empty()) return box;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p(corner & 1 ? of.max.x : of.min.x, corner & 2 ? of.max.y : of.min.y, corner & 4 ? of.max.z : of.min.z);
    box.add(vec3(dvec3(frame * glm::dvec4(p, 1.0))));
  }
  return box;
}

Box bounds_of(const State& state, const std::vector<dmat4>& frames, std::span<const NodeId> only) {
  const std::vector<bool> counts = shown_nodes(state, only);
  Box box, points;
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    if (!counts[i]) continue;
    points.add(vec3(dvec3(frames[i][3])));
    box.add(bounds_of(state, i, frames[i]));
  }
  return box.empty() ? points : box;
}

Box bounds_of(const State& state, std::span<const NodeId> only) {
  return bounds_of(state, world_frames(state), only);
}

}  // namespace pliant
