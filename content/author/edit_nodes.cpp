#include "content/author/edit_nodes.h"

#include <algorithm>
#include <map>
#include <set>

#include "content/keys/sliders.h"

namespace pliant {

namespace {

LevelNode& at(Level& level, std::int32_t node) {
  return level.nodes[static_cast<std::size_t>(node)];
}

void erase(std::vector<std::int32_t>& from, std::int32_t value) {
  from.erase(std::remove(from.begin(), from.end(), value), from.end());
}

// Parents before children, roots of the shown scene first. Nodes that no root reaches are removed.
NodesMoved put_in_order(Level& level, const std::set<std::int32_t>& gone = {}) {
  std::vector<std::int32_t> stack, order;
  for (const bool in_scene : {false, true})
    for (std::size_t i = level.nodes.size(); i-- > 0;)
      if (level.nodes[i].parent < 0 && level.nodes[i].in_scene == in_scene)
        stack.push_back(static_cast<std::int32_t>(i));
  NodesMoved moved(level.nodes.size(), kNoLevelNode);
  while (!stack.empty()) {
    const std::int32_t node = stack.back();
    stack.pop_back();
    if (gone.count(node)) continue;
    moved[static_cast<std::size_t>(node)] = static_cast<std::int32_t>(order.size());
    order.push_back(node);
    const std::vector<std::int32_t>& children = at(level, node).children;
    stack.insert(stack.end(), children.rbegin(), children.rend());
  }
  const auto now = [&](std::int32_t node) { return node < 0 ? kNoLevelNode : moved[static_cast<std::size_t>(node)]; };
  std::vector<LevelNode> nodes;
  nodes.reserve(order.size());
  for (const std::int32_t node : order) {
    LevelNode& made = nodes.emplace_back(std::move(at(level, node)));
    made.parent = now(made.parent);
    if (made.parent >= 0) made.in_scene = nodes[static_cast<std::size_t>(made.parent)].in_scene;
    for (std::int32_t& child : made.children) child = now(child);
    erase(made.children, kNoLevelNode);
  }
  level.nodes = std::move(nodes);
  for (LevelAnimation& animation : level.animations) {
    for (LevelChannel& channel : animation.channels) channel.node = now(channel.node);
    std::erase_if(animation.channels, [](const LevelChannel& channel) { return channel.node < 0; });
  }
  return moved;
}

// The node and all below it.
std::vector<std::int32_t> subtree(const Level& level, std::int32_t root) {
  std::vector<std::int32_t> out{root};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::vector<std::int32_t>& children = level.nodes[static_cast<std::size_t>(out[i])].children;
    out.insert(out.end(), children.begin(), children.end());
  }
  return out;
}

void drop_meshes(Level& level, const std::set<std::int32_t>& shown_before) {
  std::set<std::int32_t> shown;
  for (const LevelNode& node : level.nodes) shown.insert(node.mesh);
  std::vector<std::int32_t> now(level.meshes.size());
  std::vector<LevelMesh> kept;
  for (std::size_t m = 0; m < now.size(); ++m) {
    const std::int32_t mesh = static_cast<std::int32_t>(m);
    const bool stays = !shown_before.count(mesh) || shown.count(mesh);
    now[m] = stays ? static_cast<std::int32_t>(kept.size()) : -1;
    if (stays) kept.push_back(std::move(level.meshes[m]));
  }
  level.meshes = std::move(kept);
  for (LevelNode& node : level.nodes)
    if (node.mesh >= 0) node.mesh = now[static_cast<std::size_t>(node.mesh)];
}

// The nearest translation, rotation and scale; shear is lost.
LocalTransform decomposed(const dmat4& m) {
  dmat3 axes(m);
  dvec3 scale(length(axes[0]), length(axes[1]), length(axes[2]));
  if (glm::determinant(axes) < 0.0) scale.x = -scale.x;
  LocalTransform out;
  for (int i = 0; i < 3; ++i)
    if (scale[i] != 0.0) axes[i] /= scale[i];
  axes[1] = normalize(axes[1] - dot(axes[1], axes[0]) * axes[0]);
  axes[2] = cross(axes[0], axes[1]);
  out.translation = vec3(dvec3(m[3]));
  out.rotation = quat(glm::normalize(glm::quat_cast(axes)));
  out.scale = vec3(scale);
  return out;
}

}  // namespace

std::string free_name(const Level& level, const std::string& wanted) {
  std::set<std::string> taken;
  for (const LevelNode& node : level.nodes) taken.insert(node.name);
  std::string name = wanted.empty() ? "node" : wanted;
  for (int number = 2; taken.count(name); ++number)
    name = (wanted.empty() ? "node" : wanted) + "_" + std::to_string(number);
  return name;
}

std::int32_t add_node(Level& level, LevelNode node, std::int32_t parent, NodesMoved* moved) {
  const std::int32_t number = static_cast<std::int32_t>(level.nodes.size());
  node.name = free_name(level, node.name);
  node.source = -1;
  node.parent = parent;
  node.children.clear();
  node.in_scene = parent < 0 || at(level, parent).in_scene;
  level.nodes.push_back(std::move(node));
  if (parent >= 0) at(level, parent).children.push_back(number);
  const NodesMoved went = put_in_order(level);
  if (moved) *moved = NodesMoved(went.begin(), went.end() - 1);
  return went.back();
}

std::int32_t copy_node(Level& level, std::int32_t node, NodesMoved* moved) {
  const std::size_t before = level.nodes.size();
  const std::vector<std::int32_t> all = subtree(level, node);
  std::map<std::int32_t, std::int32_t> copy;  // original -> its copy
  std::map<std::string, std::string> device, probe, body;
  for (const std::int32_t each : all) {
    LevelNode made = at(level, each);
    made.source = -1;
    made.name = free_name(level, made.name);
    if (made.device) device[at(level, each).name] = made.name;
    if (made.probe) probe[at(level, each).name] = made.name;
    if (made.soft_body || made.rigid_body) body[at(level, each).name] = made.name;
    copy[each] = static_cast<std::int32_t>(level.nodes.size());
    level.nodes.push_back(std::move(made));
  }
  for (const std::int32_t each : all) {
    LevelNode& made = at(level, copy[each]);
    for (std::int32_t& child : made.children) child = copy[child];
    if (each != node) made.parent = copy[made.parent];
    if (const auto it = device.find(made.probe_device); it != device.end()) made.probe_device = it->second;
    if (made.handle)
      if (const auto it = device.find(made.handle->device); it != device.end()) made.handle->device = it->second;
    if (made.effect)
      for (std::string& name : made.effect->probes)
        if (const auto it = probe.find(name); it != probe.end()) name = it->second;
    if (made.joint)
      for (std::string* const name : {&made.joint->a, &made.joint->b, &made.joint->grip})
        if (const auto it = body.find(*name); it != body.end()) *name = it->second;
  }
  if (const std::int32_t parent = at(level, node).parent; parent >= 0) {
    std::vector<std::int32_t>& beside = at(level, parent).children;
    beside.insert(std::find(beside.begin(), beside.end(), node) + 1, copy[node]);
  }
  const NodesMoved went = put_in_order(level);
  if (moved) moved->assign(went.begin(), went.begin() + static_cast<std::ptrdiff_t>(before));
  return went[static_cast<std::size_t>(copy[node])];
}

NodesMoved remove_node(Level& level, std::int32_t node) {
  const std::vector<std::int32_t> all = subtree(level, node);
  std::set<std::int32_t> meshes;
  std::set<std::string> devices, probes, bodies;
  for (const std::int32_t each : all) {
    meshes.insert(at(level, each).mesh);
    if (at(level, each).device) devices.insert(at(level, each).name);
    if (at(level, each).probe) probes.insert(at(level, each).name);
    if (at(level, each).soft_body || at(level, each).rigid_body) bodies.insert(at(level, each).name);
  }
  NodesMoved moved = put_in_order(level, {all.begin(), all.end()});
  drop_meshes(level, meshes);
  // A node that refers to a removed device refers to none afterwards.
  for (const LevelNode& left : level.nodes) {
    if (left.device) devices.erase(left.name);
    if (left.probe) probes.erase(left.name);
    if (left.soft_body || left.rigid_body) bodies.erase(left.name);
  }
  for (LevelNode& left : level.nodes) {
    if (devices.count(left.probe_device)) left.probe_device.clear();
    if (left.handle && devices.count(left.handle->device)) left.handle->device.clear();
    if (left.effect)
      for (const std::string& name : probes) forget_probe(*left.effect, name);
    for (const std::string& name : bodies) rename_body(left, name, {});
  }
  return moved;
}

void rename_body(LevelNode& node, const std::string& from, const std::string& to) {
  if (node.joint && to.empty() && node.joint->grip == from) node.joint->grip.clear();
  if (!node.joint || (node.joint->a != from && node.joint->b != from && node.joint->grip != from)) return;
  if (to.empty()) return node.joint.reset();
  for (std::string* const name : {&node.joint->a, &node.joint->b, &node.joint->grip})
    if (*name == from) *name = to;
}

void forget_probe(Effect& effect, const std::string& probe) {
  std::vector<std::string>& names = effect.probes;
  if (std::any_of(names.begin(), names.end(), [&](const std::string& name) { return name != probe; }))
    std::erase(names, probe);
}

Result<NodesMoved> move_node(Level& level, std::int32_t node, std::int32_t parent, std::size_t place) {
  const std::vector<std::int32_t> all = subtree(level, node);
  if (std::find(all.begin(), all.end(), parent) != all.end())
    return Error{at(level, node).name, "cannot be a child of itself or of what is below it", "choose another parent"};
  const std::vector<dmat4> world = world_matrices(level.nodes);
  const std::int32_t old = at(level, node).parent;
  if (old != parent) {
    const dmat4 frame = parent < 0 ? dmat4(1.0) : world[static_cast<std::size_t>(parent)];
    if (glm::determinant(dmat3(frame)) == 0.0)
      return Error{at(level, parent).name, "has a scale of zero, so nothing can be placed in it",
                   "choose another parent"};
    at(level, node).local = decomposed(glm::inverse(frame) * world[static_cast<std::size_t>(node)]);
  }
  if (old >= 0) erase(at(level, old).children, node);
  at(level, node).parent = parent;
  if (parent >= 0) {
    std::vector<std::int32_t>& children = at(level, parent).children;
    children.insert(children.begin() + static_cast<std::ptrdiff_t>(std::min(place, children.size())), node);
    return put_in_order(level);
  }
  // Roots are ordered by number: the node goes before the root that now has its place.
  at(level, node).in_scene = true;
  std::vector<std::int32_t> roots;
  for (std::size_t i = 0; i < level.nodes.size(); ++i)
    if (level.nodes[i].parent < 0 && level.nodes[i].in_scene && static_cast<std::int32_t>(i) != node)
      roots.push_back(static_cast<std::int32_t>(i));
  roots.insert(roots.begin() + static_cast<std::ptrdiff_t>(std::min(place, roots.size())), node);
  // A temporary common parent, used only to order the roots.
  const std::size_t count = level.nodes.size();
  LevelNode all_roots;
  all_roots.children = roots;
  level.nodes.push_back(std::move(all_roots));
  for (const std::int32_t root : roots) at(level, root).parent = static_cast<std::int32_t>(count);
  NodesMoved moved = put_in_order(level);
  // It is now the first node of all.
  level.nodes.erase(level.nodes.begin());
  for (LevelNode& each : level.nodes) {
    each.parent = each.parent <= 0 ? kNoLevelNode : each.parent - 1;
    for (std::int32_t& child : each.children) --child;
  }
  for (LevelAnimation& animation : level.animations)
    for (LevelChannel& channel : animation.channels) --channel.node;
  moved.pop_back();
  for (std::int32_t& number : moved) --number;
  return moved;
}

Status rename_node(Level& level, std::int32_t node, const std::string& name) {
  if (name.empty()) return Error{at(level, node).name, "needs a name of one letter at least"};
  const std::string old = at(level, node).name;
  at(level, node).name = name;
  bool device = at(level, node).device.has_value(), probe = at(level, node).probe.has_value();
  bool body = at(level, node).soft_body || at(level, node).rigid_body;
  for (const LevelNode& each : level.nodes) {
    body = body && !((each.soft_body || each.rigid_body) && each.name == old);
    device = device && !(each.device && each.name == old);
    probe = probe && !(each.probe && each.name == old);
  }
  for (LevelNode& each : level.nodes) {
    if (device && each.probe_device == old) each.probe_device = name;
    if (device && each.handle && each.handle->device == old) each.handle->device = name;
    if (body) rename_body(each, old, name);
    if (probe && each.effect) std::replace(each.effect->probes.begin(), each.effect->probes.end(), old, name);
  }
  if (!std::any_of(level.nodes.begin(), level.nodes.end(), [&](const LevelNode& each) { return each.name == old; }))
    rename_exposed(level.simulation, old, name);
  return Done{};
}

}  // namespace pliant
