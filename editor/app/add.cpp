#include "editor/app/add.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "components/kinematic.h"
#include "content/author/object_frame.h"
#include "content/level/unit.h"
#include "editor/document/named_files.h"
#include "editor/viewport/frames.h"

namespace pliant {
namespace {

// As a root of the scene.
void add(Editor& editor, const char* what, LevelNode node) {
  const NodeId id = editor.document.new_id();
  if (editor.apply(what, with_node(editor.state(), id, kNoNode, std::move(node)))) editor.selected = {id};
}

Box around(const Editor& editor) {
  const Box selected = bounds_of(editor.state(), editor.selected);
  const Box box = editor.selected.empty() || selected.empty() ? editor.scene_box() : selected;
  return box;
}

// In the middle of the view; where that is taken, beside it, along the world's axis that points most to the right.
dvec3 free_place(const Editor& editor, dvec3 half) {
  constexpr double kGap = 0.2;  // [1] of the size
  const Viewpoint view = editor.camera.viewpoint();
  const dvec3 right = cross(view.target - view.eye, view.up), most = glm::abs(right);
  dvec3 along(0);
  along[most.x >= most.z ? 0 : 2] = (most.x >= most.z ? right.x : right.z) < 0.0 ? -1.0 : 1.0;
  const auto taken = [&](dvec3 at) {
    for (const auto& each : editor.state().nodes) {
      if (each->node.mesh < 0) continue;
      const NodeId id = each->id;
      const Box box = bounds_of(editor.state(), std::span(&id, 1));
      if (!box.empty() && glm::all(glm::lessThan(at - half, dvec3(box.max))) &&
          glm::all(glm::greaterThan(at + half, dvec3(box.min))))
        return true;
    }
    return false;
  };
  dvec3 at = view.target;
  const double step = (1.0 + kGap) * 2.0 * dot(glm::abs(along), half);
  constexpr int kMost = 100;
  for (int i = 0; i < kMost && taken(at); ++i) at += step * along;
  return at;
}

// [m] A third of the view's height, as a round number; in an empty level 0.1.
double usual_size(const Editor& editor) {
  if (editor.scene_box().empty()) return 0.1;
  const double third = orthographic_height(editor.camera.viewpoint()) / 3.0;
  const double power = std::pow(10.0, std::floor(std::log10(third)));
  return power * (third >= 5.0 * power ? 5.0 : third >= 2.0 * power ? 2.0 : 1.0);
}

// The largest mesh that is neither an instrument nor fixed to one.
const DocumentNode* largest_object(const Editor& editor) {
  const DocumentNode* largest = nullptr;
  float most = 0.0f;
  for (const auto& each : editor.state().nodes) {
    if (each->node.mesh < 0 || each->node.handle || !each->node.in_scene) continue;
    const NodeId id = each->id;
    const float size = bounds_of(editor.state(), std::span(&id, 1)).diagonal();
    if (size > most) most = size, largest = each.get();
  }
  return largest;
}

vec3 middle(const Box& box) {
  return box.empty() ? vec3(0) : 0.5f * (box.min + box.max);
}

}  // namespace

void add_shape(Editor& editor, const SimpleShape& shape) {
  const double size = usual_size(editor);
  LevelMesh mesh{shape.word, {shape_of(shape.kind, size)}};
  Box box;
  for (const vec3& p : mesh.primitives[0].position) box.add(p);
  LevelNode node;
  node.name = unique_name(editor.state(), shape.word);
  node.local.translation = vec3(free_place(editor, 0.5 * dvec3(box.size())));
  Material material;
  material.name = node.name;
  const NodeId id = editor.document.new_id();
  if (!editor.apply(std::string("Add a ") + shape.word,
                    with_object(editor.state(), id, std::move(node), std::move(mesh), std::move(material))))
    return;
  editor.selected = {id};
  editor.camera.frame(editor.scene_box());
}

const DocumentNode* touched_object(const Editor& editor) {
  const DocumentNode* const selected = editor.active_node();
  return selected && selected->node.mesh >= 0 && !selected->node.handle ? selected : largest_object(editor);
}

bool author_node(Editor& editor, const std::string& what, const DocumentNode& node, const NodeEdit& edit,
                 bool select_new) {
  const NodeId before = editor.document.next_id();
  const std::string name = node.node.name;
  const bool done = editor.apply(what, by_level(editor.state(), editor.document.next_id(), [&](Level& level) {
                                   const std::int32_t at = place_in(level, name);
                                   return at < 0 ? Status(Error{name, "is not there any more"}) : edit(level, at);
                                 }));
  if (done && select_new)
    for (const auto& each : editor.state().nodes)
      if (each->id >= before) {
        editor.selected = {each->id};
        break;
      }
  return done;
}

std::int32_t place_in(const Level& level, const std::string& name) {
  for (std::size_t i = 0; i < level.nodes.size(); ++i)
    if (level.nodes[i].name == name) return static_cast<std::int32_t>(i);
  return -1;
}

void add_instrument(Editor& editor, const Instrument& instrument) {
  const DocumentNode* const object = touched_object(editor);
  if (!object) return;
  author_node(
      editor, std::string("Add ") + instrument.word, *object,
      [&](Level& level, std::int32_t at) {
        const Result<std::int32_t> added = add_instrument(level, instrument.kind, at);
        return added ? Status(Done{}) : Status(added.error());
      },
      true);
}

bool add_level(Editor& editor, const std::string& name, Level level, double metres) {
  scale_roots(level, metres);
  const bool first = editor.scene_box().empty();
  if (const Box box = bounds(level); !first && !box.empty()) {
    const vec3 way(free_place(editor, 0.5 * dvec3(box.size())) - dvec3(box.center()));
    for (LevelNode& node : level.nodes)
      if (node.parent < 0) node.local.translation += way;
  }
  const std::size_t animations = level.animations.size();
  NodeId numbers = 1;
  const State from = state_of(std::move(level), numbers);
  std::vector<NodeId> roots, added;
  for (const auto& each : from.nodes)
    if (each->parent == kNoNode && each->node.in_scene) roots.push_back(each->id);
  if (!editor.apply("Add " + name, pasted(editor.state(), from, roots, kNoNode, editor.document.next_id(), &added)))
    return false;
  editor.selected = added;
  editor.camera.frame(editor.scene_box());
  editor.say("Added " + name);
  if (animations > 0) editor.say("Its animations are left out: open the file to have them", Severity::kWarning);
  if (const std::vector<std::string> names = named_files(from); !names.empty())
    editor.say(fmt::format("{} names files beside it; put them beside this level: {}", name, fmt::join(names, ", ")),
               Severity::kWarning);
  return true;
}

void add_empty(Editor& editor) {
  LevelNode node;
  node.name = "node";
  node.local.translation = middle(around(editor));
  add(editor, "Add a node", std::move(node));
}

void add_probe(Editor& editor) {
  const Box box = around(editor);
  LevelNode node;
  node.name = unique_name(editor.state(), "probe");
  node.probe.emplace();
  node.device.emplace();
  node.device->driver = DriverKind::kMouse;
  node.probe_device = node.name;
  const float size = box.empty() ? 0.1f : box.diagonal();
  node.probe->radius = std::clamp(0.03 * static_cast<double>(size), 1e-4, 0.05);
  node.local.translation = middle(box);
  node.local.translation.y = (box.empty() ? 0.0f : box.max.y) + 0.1f * size;
  add(editor, "Add a probe", std::move(node));
}

void add_effect(Editor& editor) {
  const Box box = around(editor);
  const double size = box.empty() ? 0.1 : static_cast<double>(box.diagonal());
  LevelNode node;
  node.name = unique_name(editor.state(), "effect");
  node.effect.emplace();
  node.effect->radius = std::clamp(0.5 * size, 1e-3, 1.0);
  node.effect->range = std::clamp(0.25 * size, 1e-3, 1.0);
  node.local.translation = middle(box);
  add(editor, "Add an effect", std::move(node));
}

void add_light(Editor& editor) {
  const Box box = around(editor);
  LevelNode node;
  node.name = "light";
  node.light.emplace();
  node.light->kind = Light::Kind::kDirectional;
  node.light->intensity = 3.0f;
  node.local.rotation = glm::quat(vec3(-0.9f, 0.6f, 0.0f));
  const float size = box.empty() ? 0.1f : box.diagonal();
  node.local.translation = middle(box) + vec3(0.5f, 0.8f, 0.5f) * size;
  add(editor, "Add a light", std::move(node));
}

Viewpoint view_of_camera(const Editor& editor, const DocumentNode& camera) {
  const dmat4 world = editor.state().to_world(camera.id);
  Viewpoint view;
  view.eye = dvec3(world[3]);
  const dvec3 forward = -glm::normalize(dvec3(world[2]));
  const Box box = editor.scene_box();
  const double deep = box.empty() ? 0.0 : dot(dvec3(box.center()) - view.eye, forward);
  view.target = view.eye + (deep > 0.0 ? deep : 1.0) * forward;
  view.up = glm::normalize(dvec3(world[1]));
  if (camera.node.camera) view.yfov = camera.node.camera->yfov;
  return view;
}

void look_through(Editor& editor, const DocumentNode& camera) {
  editor.camera = CameraControl(view_of_camera(editor, camera), editor.scene_box());
}

LocalTransform camera_place(const Editor& editor, const DocumentNode& camera) {
  const Viewpoint view = editor.camera.viewpoint();
  LocalTransform local = looking(view.eye, view.target, view.up);
  const dmat4 parent = editor.state().to_world(camera.parent);
  const dmat4 below = glm::inverse(parent);
  local.translation = vec3(below * glm::dvec4(dvec3(local.translation), 1.0));
  local.rotation = glm::normalize(quat(glm::inverse(rigid_part(parent).rotation)) * local.rotation);
  return local;
}

void add_camera(Editor& editor) {
  const Viewpoint view = editor.camera.viewpoint();
  LevelNode node;
  node.name = "camera";
  node.camera.emplace();
  node.camera->yfov = static_cast<float>(view.yfov);
  node.local.translation = vec3(view.eye);
  const dvec3 forward = glm::normalize(view.target - view.eye);
  node.local.rotation = glm::quat(glm::quatLookAt(forward, dvec3(0, 1, 0)));
  add(editor, "Add a camera", std::move(node));
}

}  // namespace pliant
