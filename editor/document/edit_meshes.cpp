// Paint, meshes and scripts, and edits of a whole level.
#include <algorithm>
#include <utility>

#include "editor/document/edit_parts.h"

namespace pliant {

Result<State> with_layer(const State& state, const LayerKey& key, PaintLayer layer) {
  if (key.mesh >= state.meshes.size() || key.primitive >= state.meshes[key.mesh]->primitives.size() ||
      layer.size() != state.meshes[key.mesh]->primitives[key.primitive].position.size())
    return Error{"paint", "does not fit the mesh"};
  State next = state;
  next.paint.insert_or_assign(key, std::move(layer));
  return next;
}

Result<State> without_layer(const State& state, std::uint32_t mesh, Channel channel) {
  State next = state;
  std::erase_if(next.paint, [&](const auto& each) { return each.first.mesh == mesh && each.first.channel == channel; });
  return next;
}

Result<State> with_mesh(const State& state, NodeId id, LevelMesh mesh) {
  std::optional<NodeChange> change = changing(state, id);
  if (!change) return kNoSuchNode;
  State& next = change->state;
  const auto number = static_cast<std::uint32_t>(next.meshes.size());
  for (std::uint32_t p = 0; p < mesh.primitives.size(); ++p)
    for (const Channel channel : kChannels) {
      std::vector<float>& values = painted(mesh.primitives[p], channel);
      if (!values.empty()) next.paint.insert_or_assign({number, p, channel}, PaintLayer::from(values));
      values = {};
    }
  mesh.source = -1;
  next.meshes.push_back(std::make_shared<const DocumentMesh>(std::move(mesh)));
  change->node->node.mesh = static_cast<std::int32_t>(number);
  return std::move(change->state);
}

Result<State> with_script(const State& state, NodeId id, const std::string& file, const ScriptKeys& keys) {
  std::optional<NodeChange> change = changing(state, id);
  if (!change) return kNoSuchNode;
  LevelNode& node = change->node->node;
  if (!node.device) return Error{node.name, "has no haptic device", "add one first"};
  if (file.empty() || file.find('/') != std::string::npos)
    return Error{file, "is no name for a script", "it lies beside the level, without a folder"};
  node.device->driver = keys.keys.empty() ? DriverKind::kNull : DriverKind::kScript;
  node.device->file = keys.keys.empty() ? "" : file;
  if (keys.keys.empty())
    change->state.scripts.erase(file);
  else
    change->state.scripts[file] = std::make_shared<const ScriptKeys>(keys);
  return std::move(change->state);
}

namespace {

// Meshes of which an edit has changed the materials get new numbers, with their paint.
void renumber_changed(State& next, const State& before) {
  const auto same_materials = [](const LevelMesh& a, const LevelMesh& b) {
    return std::equal(a.primitives.begin(), a.primitives.end(), b.primitives.begin(), b.primitives.end(),
                      [](const Primitive& x, const Primitive& y) { return x.material == y.material; });
  };
  for (std::size_t i = 0; i < before.meshes.size(); ++i) {
    const std::shared_ptr<const DocumentMesh> changed = std::exchange(next.meshes[i], before.meshes[i]);
    if (same_materials(*changed, *before.meshes[i])) continue;
    const auto from = static_cast<std::uint32_t>(i), number = static_cast<std::uint32_t>(next.meshes.size());
    next.meshes.push_back(changed);
    std::vector<std::pair<LayerKey, PaintLayer>> layers;
    for (const auto& [key, layer] : next.paint)
      if (key.mesh == from) layers.push_back({{number, key.primitive, key.channel}, layer});
    for (auto& [key, layer] : layers) next.paint.emplace(key, std::move(layer));
    for (auto& each : next.nodes) {
      if (each->node.mesh != static_cast<std::int32_t>(i)) continue;
      auto node = std::make_shared<DocumentNode>(*each);
      node->node.mesh = static_cast<std::int32_t>(number);
      each = std::move(node);
    }
  }
}

}  // namespace

Result<State> by_level(const State& state, NodeId& next_id, const std::function<Status(Level&)>& edit) {
  Level level = level_of(state);
  // Nodes are marked to identify them after the edit, wherever it inserts new ones.
  constexpr std::int32_t kMark = -2;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) level.nodes[i].source = kMark - static_cast<std::int32_t>(i);
  if (Status s = edit(level); !s) return s.error();
  if (level.nodes.size() < state.nodes.size() || level.meshes.size() < state.meshes.size())
    return Error{"edit", "an edit of a level may not remove nodes or meshes"};
  std::vector<NodeId> id_of;  // of each node of the changed level
  NodeId fresh = next_id;
  for (LevelNode& node : level.nodes) {
    const bool known = node.source <= kMark;
    const auto before = static_cast<std::size_t>(kMark - node.source);
    id_of.push_back(known ? state.nodes[before]->id : fresh++);
    node.source = known ? state.nodes[before]->node.source : -1;
  }
  NodeId numbers = 1;
  State next = state_of(std::move(level), numbers);  // numbered from 1 on, in order
  for (auto& each : next.nodes) {
    auto node = std::make_shared<DocumentNode>(*each);
    node->id = id_of[each->id - 1];
    if (each->parent != kNoNode) node->parent = id_of[each->parent - 1];
    each = std::move(node);
  }
  next_id = fresh;
  // Unchanged data stay shared.
  renumber_changed(next, state);
  for (auto& [key, layer] : next.paint)
    if (const auto before = state.paint.find(key); before != state.paint.end() && before->second == layer)
      layer = before->second;
  if (next.materials().size() == state.materials().size()) next.looks = state.looks;
  if (next.rest->images.size() == state.rest->images.size()) next.rest = state.rest;
  next.scripts = state.scripts;
  return next;
}

}  // namespace pliant
