#include "editor/document/edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <set>

#include "content/author/edit_nodes.h"
#include "content/keys/sliders.h"
#include "editor/document/edit_parts.h"

namespace pliant {

std::optional<NodeChange> changing(const State& state, NodeId id) {
  const std::size_t at = state.place(id);
  if (at >= state.nodes.size()) return {};
  NodeChange change{state, std::make_shared<DocumentNode>(*state.nodes[at])};
  change.state.nodes[at] = change.node;
  return change;
}

void rename_references(State& state, const std::string from, const std::string to) {
  for (auto& each : state.nodes) {
    const LevelNode& node = each->node;
    const bool probe = node.probe && node.probe_device == from, handle = node.handle && node.handle->device == from,
               felt = node.effect && std::count(node.effect->probes.begin(), node.effect->probes.end(), from) > 0;
    const bool joined = node.joint && (node.joint->a == from || node.joint->b == from || node.joint->grip == from);
    if (!probe && !handle && !felt && !joined) continue;
    auto changed = std::make_shared<DocumentNode>(*each);
    if (joined) rename_body(changed->node, from, to);
    if (probe) changed->node.probe_device = to;
    if (handle) changed->node.handle->device = to;
    if (felt && to.empty())
      forget_probe(*changed->node.effect, from);
    else if (felt)
      std::replace(changed->node.effect->probes.begin(), changed->node.effect->probes.end(), from, to);
    each = std::move(changed);
  }
  if (!state.find(from)) rename_exposed(state.simulation, from, to);
}

namespace {

std::optional<std::string> fault_of_name(const std::string& name) {
  if (name.empty()) return "a node needs a name";
  if (name.size() > 200) return "the name is longer than 200 bytes; choose a shorter one";
  return {};
}

// Parents before children, siblings in their order.
void put_in_order(State& state) {
  std::map<NodeId, std::vector<std::shared_ptr<const DocumentNode>>> below;
  for (const auto& each : state.nodes) below[each->parent].push_back(each);
  std::vector<std::shared_ptr<const DocumentNode>> order;
  const std::function<void(NodeId)> add = [&](NodeId id) {
    for (const auto& each : below[id]) {
      order.push_back(each);
      add(each->id);
    }
  };
  add(kNoNode);
  state.nodes = std::move(order);
}

LocalTransform local_of(const dmat4& m) {
  LocalTransform local;
  dmat3 axes(m);
  dvec3 scale(length(axes[0]), length(axes[1]), length(axes[2]));
  if (glm::determinant(axes) < 0.0) scale.x = -scale.x;
  for (int i = 0; i < 3; ++i) axes[i] /= scale[i];
  local.translation = vec3(dvec3(m[3]));
  local.rotation = quat(glm::normalize(glm::quat_cast(axes)));
  local.scale = vec3(scale);
  return local;
}

// The ids that have no ancestor among them, each once.
std::vector<NodeId> topmost(const State& state, NodeIds ids) {
  const std::set<NodeId> wanted(ids.begin(), ids.end());
  std::set<NodeId> inside;  // below one of them
  for (const auto& each : state.nodes)
    if (wanted.contains(each->parent) || inside.contains(each->parent)) inside.insert(each->id);
  std::vector<NodeId> top;
  std::set<NodeId> taken;
  for (const NodeId id : ids)
    if (!inside.contains(id) && state.find(id) && taken.insert(id).second) top.push_back(id);
  return top;
}

State add_copies(State next, const State& from, NodeIds ids, std::optional<NodeId> under, NodeId& next_id,
                 std::vector<NodeId>* ids_out, const std::map<std::int32_t, std::int32_t>* mesh_of) {
  std::map<NodeId, NodeId> copy_of;
  std::vector<std::pair<std::string, std::string>> names;
  std::vector<std::size_t> copies;
  for (const NodeId top : topmost(from, ids))
    for (const auto& each : from.nodes) {
      if (!from.below(each->id, top)) continue;
      auto copy = std::make_shared<DocumentNode>(*each);
      copy->id = next_id++;
      copy_of[each->id] = copy->id;
      if (each->id == top) {
        if (under) copy->parent = *under;
        if (ids_out) ids_out->push_back(copy->id);
      } else {
        copy->parent = copy_of[each->parent];
      }
      if (mesh_of && copy->node.mesh >= 0) copy->node.mesh = mesh_of->at(copy->node.mesh);
      copy->node.source = -1;
      copy->node.name = unique_name(next, each->node.name);
      names.emplace_back(each->node.name, copy->node.name);
      copies.push_back(next.nodes.size());
      next.nodes.push_back(std::move(copy));
    }
  const auto follow = [&](std::string& reference) {
    for (const auto& [before, after] : names)
      if (reference == before) {
        reference = after;
        return;
      }
  };
  for (const std::size_t at : copies) {
    auto copy = std::make_shared<DocumentNode>(*next.nodes[at]);
    follow(copy->node.probe_device);
    if (copy->node.handle) follow(copy->node.handle->device);
    if (copy->node.effect)
      for (std::string& probe : copy->node.effect->probes) follow(probe);
    if (copy->node.joint) follow(copy->node.joint->a), follow(copy->node.joint->b), follow(copy->node.joint->grip);
    next.nodes[at] = std::move(copy);
  }
  put_in_order(next);
  return next;
}

}  // namespace

std::string unique_name(const State& state, const std::string& wanted) {
  const std::string base = wanted.empty() ? "node" : wanted;
  if (!state.find(base)) return base;
  // "probe 2" is followed by "probe 3".
  std::string stem = base;
  const std::size_t space = stem.find_last_of(' ');
  if (space != std::string::npos && space + 1 < stem.size() && stem.size() - space < 8 &&
      std::all_of(stem.begin() + static_cast<std::ptrdiff_t>(space) + 1, stem.end(),
                  [](unsigned char c) { return std::isdigit(c); }))
    stem.resize(space);
  for (int n = 2;; ++n)
    if (std::string name = fmt::format("{} {}", stem, n); !state.find(name)) return name;
}

Result<State> renamed(const State& state, NodeId id, const std::string& name) {
  if (const auto fault = fault_of_name(name)) return Error{"rename", *fault};
  const DocumentNode* const other = state.find(name);
  if (other && other->id != id)
    return Error{"rename", "another node is called '" + name + "'",
                 "nodes are referred to by their names, choose another"};
  std::optional<NodeChange> change = changing(state, id);
  if (!change) return kNoSuchNode;
  const std::string before = change->node->node.name;
  change->node->node.name = name;
  State next = std::move(change->state);
  if (!next.find(before)) rename_references(next, before, name);
  return next;
}

Result<State> with_node(const State& state, NodeId id, NodeId parent, LevelNode node) {
  if (parent != kNoNode && !state.find(parent)) return kNoSuchNode;
  State next = state;
  auto added = std::make_shared<DocumentNode>();
  added->id = id;
  added->parent = parent;
  node.name = unique_name(state, node.name);
  node.in_scene = true;
  added->node = std::move(node);
  next.nodes.push_back(std::move(added));
  put_in_order(next);
  return next;
}

Result<State> without(const State& state, NodeIds ids) {
  State next = state;
  std::set<std::string> gone;
  std::erase_if(next.nodes, [&](const auto& each) {
    const bool goes = std::any_of(ids.begin(), ids.end(), [&](NodeId id) { return state.below(each->id, id); });
    if (goes) gone.insert(each->node.name);
    return goes;
  });
  if (gone.empty()) return kNoSuchNode;
  for (const auto& each : next.nodes) gone.erase(each->node.name);
  for (const std::string& name : gone) rename_references(next, name, "");
  return next;
}

Result<State> duplicated(const State& state, NodeIds ids, NodeId& next_id, std::vector<NodeId>* ids_out) {
  if (topmost(state, ids).empty()) return kNoSuchNode;
  return add_copies(state, state, ids, {}, next_id, ids_out, nullptr);
}

Result<State> pasted(const State& state, const State& from, NodeIds ids, NodeId parent, NodeId& next_id,
                     std::vector<NodeId>* ids_out) {
  if (parent != kNoNode && !state.find(parent)) return kNoSuchNode;
  const std::vector<NodeId> tops = topmost(from, ids);
  if (tops.empty()) return Error{"paste", "there is nothing to paste", "copy a node first"};
  // A mesh that this document already has is shared; others are added.
  State next = state;
  LooksBrought looks;
  std::map<std::int32_t, std::int32_t> mesh_of;
  for (const auto& each : from.nodes) {
    const std::int32_t mesh = each->node.mesh;
    const bool comes = std::any_of(tops.begin(), tops.end(), [&](NodeId top) { return from.below(each->id, top); });
    if (!comes || mesh < 0 || mesh_of.contains(mesh)) continue;
    const auto at = static_cast<std::size_t>(mesh);
    if (at < next.meshes.size() && next.meshes[at] == from.meshes[at]) {
      mesh_of[mesh] = mesh;
      continue;
    }
    const auto number = static_cast<std::uint32_t>(next.meshes.size());
    mesh_of[mesh] = static_cast<std::int32_t>(number);
    LevelMesh copy = *from.meshes[at];
    copy.source = -1;
    copy.skinned = -1;
    if (from.looks != state.looks) looks.bring(next, from, copy);
    next.meshes.push_back(std::make_shared<const DocumentMesh>(std::move(copy)));
    for (const auto& [key, layer] : from.paint)
      if (key.mesh == at) next.paint.emplace(LayerKey{number, key.primitive, key.channel}, layer);
  }
  return add_copies(std::move(next), from, ids, parent, next_id, ids_out, &mesh_of);
}

Result<State> reparented(const State& state, NodeIds ids, NodeId parent, NodeId before) {
  const std::vector<NodeId> tops = topmost(state, ids);
  if (tops.empty() || (parent != kNoNode && !state.find(parent))) return kNoSuchNode;
  for (const NodeId id : tops)
    if (state.below(parent, id)) return Error{"reparent", "a node cannot be put below itself"};
  const dmat4 from_world = glm::inverse(state.to_world(parent));
  State next = state;
  std::vector<std::shared_ptr<const DocumentNode>> moved;
  for (const NodeId id : tops) {
    auto node = std::make_shared<DocumentNode>(*state.find(id));
    if (node->parent != parent) {
      node->node.local = local_of(from_world * state.to_world(id));
      if (const DocumentNode* above = state.find(parent)) node->node.in_scene = above->node.in_scene;
    }
    node->parent = parent;
    moved.push_back(std::move(node));
  }
  std::erase_if(next.nodes,
                [&](const auto& each) { return std::find(tops.begin(), tops.end(), each->id) != tops.end(); });
  const std::size_t at = before == kNoNode ? next.nodes.size() : next.place(before);
  next.nodes.insert(next.nodes.begin() + static_cast<std::ptrdiff_t>(at), moved.begin(), moved.end());
  put_in_order(next);
  return next;
}

Result<State> placed(const State& state, std::span<const Placing> all) {
  State next = state;
  bool any = false;
  for (const auto& [id, local] : all) {
    for (int i = 0; i < 3; ++i)
      if (!std::isfinite(local.translation[i]) || !std::isfinite(local.scale[i]) || local.scale[i] == 0.0f)
        return Error{"transform", "a position must be finite and a scale other than 0"};
    if (!(std::abs(glm::length(local.rotation) - 1.0f) < 1e-3f))
      return Error{"transform", "a rotation must be a unit quaternion"};
    const std::size_t at = next.place(id);
    if (at >= next.nodes.size()) continue;
    auto node = std::make_shared<DocumentNode>(*next.nodes[at]);
    node->node.local = local;
    next.nodes[at] = std::move(node);
    any = true;
  }
  if (!any) return kNoSuchNode;
  return next;
}

Result<State> placed(const State& state, NodeId id, const LocalTransform& local) {
  const Placing one{id, local};
  return placed(state, std::span(&one, 1));
}

Result<State> with_light(const State& state, NodeId id, const std::optional<Light>& light) {
  std::optional<NodeChange> change = changing(state, id);
  if (!change) return kNoSuchNode;
  change->node->node.light = light;
  return std::move(change->state);
}

Result<State> with_camera(const State& state, NodeId id, const std::optional<Camera>& camera) {
  std::optional<NodeChange> change = changing(state, id);
  if (!change) return kNoSuchNode;
  change->node->node.camera = camera;
  return std::move(change->state);
}

}  // namespace pliant
