#include "editor/panels/place_fields.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string>

#include "editor/panels/property_row.h"
#include "editor/viewport/gizmo_math.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr float kTripleShare = 0.30f;  // [1] of the panel's width: label before three numbers

bool triple(const char* label, const char* unit, dvec3& value, const char* hint_text) {
  // Three numbers need the space: the unit is in the label.
  property_row((*unit ? fmt::format("{} ({})", label, unit) : label).c_str(), hint_text, false, kTripleShare);
  const float wide = (ImGui::GetContentRegionAvail().x - ui::px(8)) / 3.0f / ui::scale();
  bool changed = false;
  const char* const axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    if (i) ImGui::SameLine(0, ui::px(4));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    changed |= ui::number(fmt::format("{} {}", label, axes[i]).c_str(), value[i], -1e6, 1e6,
                          (std::string("#") + unit).c_str(), false, wide);
    ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + ui::px(3), at.y + ImGui::GetFrameHeight()},
                                              ui::color(ui::palette().axis[i]), ui::px(2));
  }
  return changed;
}

}  // namespace

dvec3 world_size(const Editor& editor, const DocumentNode& node) {
  if (node.node.mesh < 0) return dvec3(0);
  const DocumentMesh& mesh = *editor.state().meshes[static_cast<std::size_t>(node.node.mesh)];
  const dmat4 world = editor.state().to_world(node.id);
  dvec3 size(0);
  for (int i = 0; i < 3 && !mesh.box.empty(); ++i)
    size[i] = static_cast<double>(mesh.box.size()[i]) * length(dvec3(world[i]));
  return size;
}

void PlaceFields::draw(Editor& editor, const DocumentNode& node) {
  if (!ui::section("Place")) return;
  LocalTransform local = node.node.local;
  // Floats represent an angle to about five digits.
  const dvec3 euler = glm::round(glm::degrees(glm::eulerAngles(dquat(local.rotation))) * 1e4) * 1e-4;
  // Lengths are shown in world units, including the parents' scale.
  const dmat4 parent = editor.state().to_world(node.parent);
  const dvec3 scaled(length(dvec3(parent[0])), length(dvec3(parent[1])), length(dvec3(parent[2])));
  const bool plain =
      glm::all(glm::lessThan(glm::abs(scaled - 1.0), dvec3(1e-6))) || glm::any(glm::lessThan(scaled, dvec3(1e-12)));
  const dvec3 factor = plain ? dvec3(1) : scaled, before = dvec3(local.translation) * factor,
              size = world_size(editor, node);
  dvec3 position = before,
        turn = shown_turn_.first == node.id && same_turn(local.rotation) ? shown_turn_.second : euler,
        scale(local.scale), wanted = size;
  bool changed = false;
  const std::string said =
      plain ? std::string()
            : fmt::format(
                  "\nThe parents scale by {:.4g}, {:.4g}, {:.4g}: what is shown and typed is in the world's "
                  "metres.",
                  factor.x, factor.y, factor.z);
  changed |= triple("Position", "m", position, ("Of the node's origin, along its parent's axes" + said).c_str());
  const bool turned = triple("Rotation", "\u00b0", turn, "About x, then y, then z of its parent's frame");
  changed |= triple("Scale", "", scale, "Along the node's own axes, within its parent");
  if (size != dvec3(0))
    changed |= triple("Size", "m", wanted, "Of the mesh in the world, along the node's own axes; changes its scale");
  for (int i = 0; i < 3; ++i)
    if (wanted[i] != size[i] && size[i] > 0.0 && wanted[i] > 0.0) scale[i] *= wanted[i] / size[i];
  if (turned) {
    local.rotation = quat(glm::normalize(dquat(glm::radians(turn))));
    shown_turn_ = {node.id, turn};
    shown_quat_ = local.rotation;
  }
  if (!changed && !turned) return;
  if (position != before) local.translation = vec3(position / factor);
  local.scale = vec3(scale);
  editor.apply("Place " + node.node.name, placed(editor.state(), node.id, local), "place " + std::to_string(node.id));
}
bool PlaceFields::same_turn(quat q) const {
  return std::abs(glm::dot(q, shown_quat_)) > 0.999999f;
}

}  // namespace pliant
