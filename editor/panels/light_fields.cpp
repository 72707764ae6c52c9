#include "editor/panels/light_fields.h"

#include <glm/gtc/constants.hpp>
#include <string>

#include "editor/app/add.h"
#include "editor/panels/property_row.h"
#include "viewer/ui/widgets.h"

namespace pliant {

void draw_light_fields(Editor& editor, const DocumentNode& node) {
  if (!node.node.light) return;
  ui::gap(2);
  if (!ui::section("Light")) return;
  const ui::Scope scope("light");
  Light light = *node.node.light;
  bool changed = false;
  std::string kind = light.kind == Light::Kind::kDirectional ? "directional"
                     : light.kind == Light::Kind::kPoint     ? "point"
                                                             : "spot";
  property_row("Kind", "Directional: from far away, along the node's -Z. Point: from its origin. Spot: a cone.", false);
  if (ui::combo("kind", kind, {"directional", "point", "spot"})) {
    light.kind = kind == "directional" ? Light::Kind::kDirectional
                 : kind == "point"     ? Light::Kind::kPoint
                                       : Light::Kind::kSpot;
    changed = true;
  }
  double intensity = static_cast<double>(light.intensity);
  property_row("Intensity", "Lux of a directional light, candela of the others", false);
  if (ui::number("intensity", intensity, 0, 1e6, light.kind == Light::Kind::kDirectional ? "lx" : "cd", true)) {
    light.intensity = static_cast<float>(intensity);
    changed = true;
  }
  property_row("Colour", "Linear RGB", false);
  changed |= ui::color_field("colour", &light.color.x);
  if (changed) editor.apply("Light", with_light(editor.state(), node.id, light), "light " + std::to_string(node.id));
  if (ui::button("Remove light")) editor.apply("Remove light", with_light(editor.state(), node.id, {}));
}

void draw_camera_fields(Editor& editor, const DocumentNode& node) {
  if (!node.node.camera) return;
  ui::gap(2);
  if (!ui::section("Camera")) return;
  const ui::Scope scope("camera");
  Camera camera = *node.node.camera;
  double degrees = glm::degrees(static_cast<double>(camera.yfov));
  property_row("Field of view", "Vertical", false);
  if (ui::number("field of view", degrees, 1, 170, "\u00b0")) {
    camera.yfov = static_cast<float>(glm::radians(degrees));
    editor.apply("Camera", with_camera(editor.state(), node.id, camera), "camera " + std::to_string(node.id));
  }
  if (ui::button("Look through", "The viewport shows what this camera sees")) look_through(editor, node);
  ImGui::SameLine(0, ui::px(4));
  if (ui::button("Place here", "The camera sees what the viewport shows"))
    editor.apply("Place the camera", placed(editor.state(), node.id, camera_place(editor, node)));
  if (ui::button("Remove camera")) editor.apply("Remove camera", with_camera(editor.state(), node.id, {}));
}

}  // namespace pliant
