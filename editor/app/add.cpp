#include "editor/app/add.h"

#include <algorithm>
#include <glm/gtc/quaternion.hpp>

#include "editor/viewport/solid_view.h"

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

vec3 middle(const Box& box) {
  return box.empty() ? vec3(0) : 0.5f * (box.min + box.max);
}

}  // namespace

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
