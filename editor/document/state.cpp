#include "editor/document/state.h"

#include <algorithm>
#include <cctype>
#include <unordered_map>

#include "content/keys/extensions.h"
#include "content/level_file.h"

namespace pliant {
namespace {

bool same_node(const DocumentNode& a, const DocumentNode& b) {
  if (a.id != b.id || a.parent != b.parent) return false;
  const LevelNode &x = a.node, &y = b.node;
  const auto light = [](const std::optional<Light>& l) {
    return l ? std::vector<double>{static_cast<double>(l->kind),
                                   l->color.x,
                                   l->color.y,
                                   l->color.z,
                                   l->intensity,
                                   l->range,
                                   l->inner_cone,
                                   l->outer_cone}
             : std::vector<double>{};
  };
  const auto camera = [](const std::optional<Camera>& c) {
    return c ? std::vector<double>{c->yfov, c->znear, c->zfar} : std::vector<double>{};
  };
  return x.name == y.name && x.local.translation == y.local.translation && x.local.rotation == y.local.rotation &&
         x.local.scale == y.local.scale && x.in_scene == y.in_scene && x.mesh == y.mesh &&
         light(x.light) == light(y.light) && camera(x.camera) == camera(y.camera) &&
         node_extensions(x, Json()) == node_extensions(y, Json());
}

Level without_nodes(const State& state) {
  Level level;
  if (state.rest) level = *state.rest;
  level.materials = state.materials();
  level.about = state.about;
  level.environment = state.environment;
  level.simulation = state.simulation;
  level.stated = state.stated;
  return level;
}

void add_nodes(const State& state, Level& level) {
  std::unordered_map<NodeId, std::int32_t> place;
  for (const auto& each : state.nodes) {
    LevelNode node = each->node;
    const auto parent = place.find(each->parent);
    node.parent = parent == place.end() ? -1 : parent->second;
    node.children.clear();
    const auto here = static_cast<std::int32_t>(level.nodes.size());
    place[each->id] = here;
    if (node.parent >= 0) level.nodes[static_cast<std::size_t>(node.parent)].children.push_back(here);
    level.nodes.push_back(std::move(node));
  }
}

}  // namespace

DocumentMesh::DocumentMesh(LevelMesh mesh) : LevelMesh(std::move(mesh)) {
  for (const Primitive& primitive : primitives)
    for (const vec3& p : primitive.position) box.add(p);
}

std::string name_of(Channel channel) {
  std::string name = painted_attribute(channel).name + 1;
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name;
}

const std::vector<Material>& State::materials() const {
  static const std::vector<Material> kNone;
  return looks ? *looks : kNone;
}

std::size_t State::place(NodeId id) const {
  // Ids are assigned in order, and edits move nodes only a little: search from the expected position in both
  // directions.
  const std::size_t count = nodes.size();
  if (count == 0) return 0;
  const std::size_t first = nodes.front()->id;
  const std::size_t guess = id > first ? std::min<std::size_t>(id - first, count - 1) : 0;
  for (std::size_t away = 0; away < count; ++away) {
    if (guess + away < count && nodes[guess + away]->id == id) return guess + away;
    if (away <= guess && nodes[guess - away]->id == id) return guess - away;
  }
  return count;
}

const DocumentNode* State::find(NodeId id) const {
  const std::size_t at = place(id);
  return at < nodes.size() ? nodes[at].get() : nullptr;
}

const DocumentNode* State::find(const std::string& name) const {
  for (const auto& each : nodes)
    if (each->node.name == name) return each.get();
  return nullptr;
}

std::vector<NodeId> State::children(NodeId id) const {
  std::vector<NodeId> found;
  for (const auto& each : nodes)
    if (each->parent == id) found.push_back(each->id);
  return found;
}

bool State::below(NodeId id, NodeId ancestor) const {
  for (const DocumentNode* at = find(id); at; at = find(at->parent))
    if (at->id == ancestor) return true;
  return false;
}

dmat4 State::to_world(NodeId id) const {
  dmat4 world(1.0);
  for (const DocumentNode* at = find(id); at; at = find(at->parent)) {
    const LocalTransform& local = at->node.local;
    dmat4 m = glm::mat4_cast(dquat(local.rotation));
    for (int c = 0; c < 3; ++c) m[c] *= static_cast<double>(local.scale[c]);
    m[3] = glm::dvec4(dvec3(local.translation), 1.0);
    world = m * world;
  }
  return world;
}

State state_of(Level level, NodeId& next_id) {
  State state;
  std::vector<NodeId> ids;
  for (LevelNode& node : level.nodes) {
    auto out = std::make_shared<DocumentNode>();
    out->id = next_id++;
    out->parent = node.parent < 0 ? kNoNode : ids[static_cast<std::size_t>(node.parent)];
    ids.push_back(out->id);
    out->node = std::move(node);
    out->node.parent = -1;
    out->node.children.clear();
    state.nodes.push_back(std::move(out));
  }
  for (LevelMesh& mesh : level.meshes) {
    const auto number = static_cast<std::uint32_t>(state.meshes.size());
    for (std::uint32_t p = 0; p < mesh.primitives.size(); ++p)
      for (const Channel channel : kChannels) {
        std::vector<float>& values = painted(mesh.primitives[p], channel);
        if (!values.empty()) state.paint.emplace(LayerKey{number, p, channel}, PaintLayer::from(values));
        values = {};
      }
    state.meshes.push_back(std::make_shared<const DocumentMesh>(std::move(mesh)));
  }
  state.looks = std::make_shared<const std::vector<Material>>(std::move(level.materials));
  state.about = std::move(level.about);
  state.environment = std::move(level.environment);
  state.simulation = level.simulation;
  state.stated = std::move(level.stated);
  level.nodes.clear();
  level.meshes.clear();
  level.materials.clear();
  level.environment.reset();
  level.about.clear();
  level.stated.clear();
  state.rest = std::make_shared<const Level>(std::move(level));
  return state;
}

Level level_of(const State& state) {
  Level level = without_nodes(state);
  add_nodes(state, level);
  for (const auto& mesh : state.meshes) level.meshes.push_back(*mesh);
  for (const auto& [key, layer] : state.paint)
    painted(level.meshes[key.mesh].primitives[key.primitive], key.channel) = layer.flatten();
  return level;
}

void drop_unseen_meshes(Level& level) {
  std::vector<std::int32_t> now(level.meshes.size(), -1);
  for (const LevelNode& node : level.nodes)
    if (node.mesh >= 0) now[static_cast<std::size_t>(node.mesh)] = 0;
  std::vector<LevelMesh> kept;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (now[i] == 0) {
      now[i] = static_cast<std::int32_t>(kept.size());
      kept.push_back(std::move(level.meshes[i]));
    }
  for (LevelNode& node : level.nodes)
    if (node.mesh >= 0) node.mesh = now[static_cast<std::size_t>(node.mesh)];
  level.meshes = std::move(kept);
}

Level outline_of(const State& state) {
  Level level;
  level.about = state.about;
  level.environment = state.environment;
  level.simulation = state.simulation;
  level.stated = state.stated;
  add_nodes(state, level);
  return level;
}

bool same(const State& a, const State& b) {
  return a.looks == b.looks && same_but_looks(a, b);
}

bool same_but_looks(const State& a, const State& b) {
  if (a.nodes.size() != b.nodes.size() || a.meshes != b.meshes || a.about != b.about || a.rest != b.rest) return false;
  for (std::size_t i = 0; i < a.nodes.size(); ++i)
    if (a.nodes[i] != b.nodes[i] && !same_node(*a.nodes[i], *b.nodes[i])) return false;
  const auto same_script = [](const auto& x, const auto& y) { return x.first == y.first && *x.second == *y.second; };
  if (!std::equal(a.scripts.begin(), a.scripts.end(), b.scripts.begin(), b.scripts.end(), same_script)) return false;
  return a.paint == b.paint && scene_extensions(outline_of(a), Json()) == scene_extensions(outline_of(b), Json());
}

void leave_out_scripts(Level& level, const Scripts& scripts, DriverKind instead) {
  for (LevelNode& node : level.nodes)
    if (node.device && node.device->driver == DriverKind::kScript && scripts.contains(node.device->file)) {
      node.device->driver = instead;
      node.device->file.clear();
    }
}

Status save_state(const State& state, const std::filesystem::path& file) {
  return save_level(level_of(state), file);
}

}  // namespace pliant
