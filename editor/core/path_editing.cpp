#include "editor/core/path_editing.h"

#include <algorithm>

#include "components/haptic_device.h"
#include "components/kinematic.h"
#include "components/probe_shape.h"
#include "content/author/object_frame.h"
#include "editor/viewport/frames.h"

namespace pliant {
namespace {

constexpr double kLeastApart = 1e-3;  // [s] between keys

// Makes a file name from a node's name.
std::string file_of(const State& state, const std::string& name) {
  std::string file;
  for (const char c : name) file += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '_';
  const std::string level = state.rest->name.empty() ? "level" : state.rest->name;
  return level + "_" + file;
}

std::vector<PathSurface> surfaces_of_paths(Editor& editor) {
  std::vector<PathSurface> all;
  for (const NodeId id : path_grounds(editor.state()))
    if (auto surface = editor.ground_now(id).surface)
      all.push_back({std::move(surface), dvec3(editor.state().to_world(id)[3])});
  return all;
}

// Moves a tool to the start of its path, so that it is not pulled there through the organ.
Result<State> standing_at(const State& state, const DocumentNode& tool, const PathRow& row) {
  const dmat4 parent = state.to_world(tool.parent);
  LocalTransform local = tool.node.local;
  local.translation = vec3(dvec3(glm::inverse(parent) * glm::dvec4(row.position, 1.0)));
  local.rotation = quat(normalize(glm::conjugate(rigid_part(parent).rotation) * row.rotation));
  return placed(state, tool.id, local);
}

// The mean of the lowest points; `up` is unit.
dvec3 lowest_of(const std::vector<dvec3>& points, dvec3 up, double& size) {
  double low = 1e300, high = -1e300;
  for (const dvec3& p : points) {
    low = std::min(low, dot(p, up));
    high = std::max(high, dot(p, up));
  }
  size = high - low;
  dvec3 sum(0);
  double count = 0;
  for (const dvec3& p : points)
    if (dot(p, up) <= low + 1e-4 * size) {
      sum += p;
      ++count;
    }
  return sum / count;
}

// Whether the tool extends from its origin down along its own -Y, as instruments made here do.
bool hangs_down(const std::vector<dvec3>& points) {
  constexpr double kShare = 0.8;
  double low = 0.0, farthest = 0.0;
  for (const dvec3& p : points) {
    low = std::min(low, p.y);
    farthest = std::max(farthest, length(p));
  }
  return -low > kShare * farthest;
}

// The largest sphere at the lowest place of a mesh that fits into it (Ma, Bae and Choi 2012), no wider than the mesh.
PathTip tip_of_mesh(const std::vector<dvec3>& points, dvec3 up) {
  double size = 0;
  const dvec3 low = lowest_of(points, up, size);
  double radius = 0.5 * size;
  dvec3 least(1e300), most(-1e300);
  const dvec3 side = normalize(std::abs(up.x) < 0.9 ? cross(up, dvec3(1, 0, 0)) : cross(up, dvec3(0, 1, 0))),
              other = cross(up, side);
  for (const dvec3& p : points) {
    const dvec3 off = p - low, across(dot(off, side), dot(off, other), 0.0);
    least = glm::min(least, across);
    most = glm::max(most, across);
    if (const double rise = dot(off, up); rise > 1e-4 * size) radius = std::min(radius, dot(off, off) / (2.0 * rise));
  }
  radius = std::min({radius, 0.5 * (most.x - least.x), 0.5 * (most.y - least.y)});
  PathTip tip;
  tip.radius = std::max(radius, 0.0);
  tip.place = low + tip.radius * up;
  tip.axis = up;
  return tip;
}

}  // namespace

NodeId effector_of(const State& state, NodeId device) {
  const DocumentNode* const of = state.find(device);
  if (!of) return kNoNode;
  for (const auto& each : state.nodes) {
    const LevelNode& node = each->node;
    if ((node.probe && node.probe_device == of->node.name) || (node.handle && node.handle->device == of->node.name))
      return each->id;
  }
  return kNoNode;
}

std::optional<PathTip> tip_of(const State& state, NodeId device) {
  const DocumentNode* const it = state.find(effector_of(state, device));
  if (!it) return {};
  const dmat4 world = state.to_world(it->id);
  const Pose pose = rigid_part(world);
  Level gravity;
  gravity.simulation = state.simulation;
  const dvec3 up = normalize(glm::conjugate(pose.rotation) * up_of(gravity));
  PathTip tip;
  if (it->node.probe) {
    const Probe& probe = *it->node.probe;
    tip.radius = probe.radius;
    const std::vector<ProbePart> parts = probe_parts(probe);
    const auto capsule = std::find_if(parts.begin(), parts.end(), [](const ProbePart& p) { return !p.is_sphere(); });
    if (capsule != parts.end()) {
      tip.place = capsule->from;
      tip.axis = normalize(capsule->to - capsule->from);
    } else if (parts.size() > 1 || parts.front().from != dvec3(0)) {
      tip.place = std::min_element(parts.begin(), parts.end(), [&](const ProbePart& a, const ProbePart& b) {
                    return dot(a.from, up) < dot(b.from, up);
                  })->from;
      tip.axis = up;
    }
  } else if (it->node.mesh >= 0) {
    std::vector<dvec3> points;
    for (const Primitive& primitive : state.meshes[static_cast<std::size_t>(it->node.mesh)]->primitives)
      for (const vec3& p : primitive.position)
        points.push_back(pose.to_local(dvec3(world * glm::dvec4(dvec3(p), 1.0))));
    if (!points.empty()) tip = tip_of_mesh(points, hangs_down(points) ? dvec3(0, 1, 0) : up);
  }
  tip.stands = pose.rotation;
  return tip;
}

std::vector<NodeId> path_grounds(const State& state) {
  std::vector<NodeId> touchable, all;
  for (const auto& each : state.nodes) {
    const LevelNode& node = each->node;
    if (node.mesh < 0 || !node.in_scene || node.handle) continue;
    all.push_back(each->id);
    if (node.deformable || node.soft_body || node.rigid_body) touchable.push_back(each->id);
  }
  return touchable.empty() ? all : touchable;
}

NodeId device_of(const State& state, NodeId id) {
  const DocumentNode* const node = state.find(id);
  if (!node) return kNoNode;
  if (node->node.device) return id;
  const std::string device = node->node.probe    ? node->node.probe_device
                             : node->node.handle ? node->node.handle->device
                                                 : "";
  const DocumentNode* const named = device.empty() ? nullptr : state.find(device);
  return named && named->node.device ? named->id : kNoNode;
}

NodeId path_node(const Editor& editor) {
  return device_of(editor.state(), editor.active());
}

std::string script_file_of(const State& state, const std::filesystem::path& folder, NodeId id) {
  const DocumentNode& node = *state.find(id);
  const std::string& has = node.node.device->file;
  if (state.scripts.contains(has)) return has;
  std::error_code failed;
  if (!has.empty() && has.find('/') == std::string::npos && !std::filesystem::exists(folder / has, failed)) return has;
  // An existing file belongs to something else.
  const std::string name = file_of(state, node.node.name);
  std::string file = name + ".csv";
  for (int i = 2; state.scripts.contains(file) || std::filesystem::exists(folder / file, failed); ++i)
    file = name + "_" + std::to_string(i) + ".csv";
  return file;
}

ScriptKeys keys_of_node(const Editor& editor, NodeId node) {
  const DocumentNode* const it = editor.state().find(node);
  if (!it || !it->node.device || it->node.device->file.empty()) return {};
  const auto script = editor.state().scripts.find(it->node.device->file);
  return script == editor.state().scripts.end() ? ScriptKeys{} : *script->second;
}

bool set_keys_of_node(Editor& editor, NodeId node, const ScriptKeys& keys, const std::string& what,
                      const std::string& gesture) {
  const DocumentNode* const it = editor.state().find(node);
  if (!it || !it->node.device) return false;
  ScriptKeys sorted = keys;
  std::stable_sort(sorted.keys.begin(), sorted.keys.end(),
                   [](const PathKey& a, const PathKey& b) { return a.time < b.time; });
  for (std::size_t i = 1; i < sorted.keys.size(); ++i)
    sorted.keys[i].time = std::max(sorted.keys[i].time, sorted.keys[i - 1].time + kLeastApart);
  sorted.rows = nullptr;
  const NodeId led = effector_of(editor.state(), node);
  const DocumentNode* const tool = editor.state().find(led);
  if (sorted.along && !sorted.keys.empty()) {
    // The tool moves to the start of its path, after which its lowest place may not be the tip's: keep the known tip.
    const bool known = keys.rows && keys.tip.axis != dvec3(0) && tool && !tool->node.probe;
    if (!known) sorted.tip = tip_of(editor.state(), node).value_or(PathTip{});
    sorted.rows = std::make_shared<const std::vector<PathRow>>(rows_along(sorted, surfaces_of_paths(editor)));
  }
  const std::string file = script_file_of(editor.state(), editor.document.folder(), node);
  Result<State> next = with_script(editor.state(), node, file, sorted);
  if (next && sorted.rows && tool && !tool->node.probe) next = standing_at(*next, *tool, sorted.rows->front());
  return editor.apply(what, std::move(next), gesture);
}

double path_clearance(const Editor& editor, NodeId node) {
  const std::optional<PathTip> tip = tip_of(editor.state(), node);
  Box box;  // without the tools, which may be long
  for (const NodeId id : path_grounds(editor.state())) {
    const NodeId ids[] = {id};
    const Box each = bounds_of(editor.state(), ids);
    if (each.empty()) continue;
    box.add(each.min);
    box.add(each.max);
  }
  return std::max(0.05 * static_cast<double>(box.empty() ? 0.0f : box.diagonal()), tip ? tip->radius : 0.0);
}

}  // namespace pliant
