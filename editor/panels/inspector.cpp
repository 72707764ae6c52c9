// Properties of the selected node: transform, components by the key table, light and camera. Without a selection: the
// scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <set>

#include "content/keys/extension_table.h"
#include "editor/app/app.h"
#include "editor/panels/key_fields.h"
#include "editor/panels/panels.h"
#include "editor/tools/gizmo_math.h"
#include "editor/ui/widgets.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

constexpr float kLabelShare = 0.42f;   // [1] of the panel's width
constexpr float kTripleShare = 0.30f;  // [1] the same, before three numbers

std::string words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  std::replace(name.begin(), name.end(), '.', ' ');
  if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

class InspectorPanel : public Panel {
 public:
  explicit InspectorPanel(App& app) : app_(app) {}
  const char* name() const override { return "Inspector"; }
  Place place() const override { return Place::kRight; }

  void draw(Editor& editor) override {
    ui::text_field("Search", search_, "Search properties");
    ui::gap(2);
    const DocumentNode* const active = editor.active_node();
    if (!active) {
      draw_scene(editor);
      return;
    }
    draw_head(editor, *active);
    if (search_.empty()) draw_transform(editor, *active);
    for (const Extension& each : extension_table())
      if (!each.on_scene) draw_component(editor, each);
    if (search_.empty()) {
      draw_light(editor, *active);
      draw_camera(editor, *active);
      draw_add(editor);
    }
  }

 private:
  void draw_head(Editor& editor, const DocumentNode& node) {
    if (editor.selected.size() > 1) {
      ui::title(fmt::format("{} nodes", editor.selected.size()).c_str());
      ui::dim("A change is made to all of them that have the component.");
      return;
    }
    if (shown_ != node.id || name_at_ != editor.document.revision()) {
      shown_ = node.id;
      name_at_ = editor.document.revision();
      new_name_ = node.node.name;
    }
    if (ui::text_field("Name", new_name_, "", 0, ImGuiInputTextFlags_EnterReturnsTrue) ||
        ImGui::IsItemDeactivatedAfterEdit()) {
      if (new_name_ != node.node.name && !editor.apply("Rename", renamed(editor.state(), node.id, new_name_)))
        new_name_ = node.node.name;
    }
    if (node.node.mesh >= 0) {
      const DocumentMesh& mesh = *editor.state().meshes[static_cast<std::size_t>(node.node.mesh)];
      std::size_t triangles = 0, vertices = 0;
      for (const Primitive& p : mesh.primitives) {
        triangles += p.index.size() / 3;
        vertices += p.position.size();
      }
      const dvec3 size = world_size(editor, node);
      ui::dim(fmt::format("{} triangles, {} vertices\n{} \u00d7 {} \u00d7 {} in the world", triangles, vertices,
                          length_text(size.x, 3), length_text(size.y, 3), length_text(size.z, 3))
                  .c_str());
    }
  }

  // [m] Along the node's own axes, including all inherited scales.
  static dvec3 world_size(const Editor& editor, const DocumentNode& node) {
    if (node.node.mesh < 0) return dvec3(0);
    const DocumentMesh& mesh = *editor.state().meshes[static_cast<std::size_t>(node.node.mesh)];
    const dmat4 world = editor.state().to_world(node.id);
    dvec3 size(0);
    for (int i = 0; i < 3 && !mesh.box.empty(); ++i)
      size[i] = static_cast<double>(mesh.box.size()[i]) * length(dvec3(world[i]));
    return size;
  }

  // A row: label at the left, field at the right. True while the label's mark for "back to the default" is pressed.
  bool begin_row(const char* label, const char* hint_text, bool differs, float share = kLabelShare) {
    const float left = ImGui::GetCursorPosX(), wide = ImGui::GetContentRegionAvail().x;
    ImGui::AlignTextToFramePadding();
    if (differs) {
      ImGui::PushStyleColor(ImGuiCol_Text, ui::palette().text);
      ImGui::TextUnformatted(label);
      ImGui::PopStyleColor();
    } else {
      ImGui::TextColored(ui::palette().dim, "%s", label);
    }
    ui::hint(hint_text);
    bool reset = false;
    if (differs) {
      ImGui::SameLine();
      ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0, 0, 0, 0));
      ImGui::PushStyleColor(ImGuiCol_Text, ui::palette().accent);
      ImGui::PushID(label);
      reset = ImGui::SmallButton("\u21ba");
      ImGui::PopID();
      ImGui::PopStyleColor(2);
      ui::known_as(std::string(label) + " reset");
      ui::hint("Differs from the default. Press to go back to it.");
    }
    ImGui::SameLine(left + share * wide);
    return reset;
  }

  void draw_transform(Editor& editor, const DocumentNode& node) {
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
  bool same_turn(quat q) const { return std::abs(glm::dot(q, shown_quat_)) > 0.999999f; }

  bool triple(const char* label, const char* unit, dvec3& value, const char* hint_text) {
    // Three numbers need the space: the unit is in the label.
    begin_row((*unit ? fmt::format("{} ({})", label, unit) : label).c_str(), hint_text, false, kTripleShare);
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

  bool found(const Extension& extension, const Key& key) const {
    if (search_.empty()) return true;
    const auto lower = [](std::string s) {
      for (char& c : s) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return s;
    };
    const std::string what = lower(search_);
    return lower(key.name).find(what) != std::string::npos || lower(key.doc).find(what) != std::string::npos ||
           lower(extension.name).find(what) != std::string::npos;
  }

  void draw_component(Editor& editor, const Extension& extension) {
    std::vector<NodeId> have;
    for (const NodeId id : editor.selected)
      if (has_component(editor.state(), id, extension.name)) have.push_back(id);
    if (have.empty()) return;
    if (!search_.empty() && std::none_of(extension.keys.begin(), extension.keys.end(),
                                         [&](const Key& key) { return found(extension, key); }))
      return;
    ui::gap(2);
    const bool open = ui::section(words(extension.name).c_str());
    ImGui::SetItemAllowOverlap();  // the reset cross on it is pressed separately
    ui::hint(extension.doc.c_str());
    const float cross = ImGui::CalcTextSize("\u00d7").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SameLine(ImGui::GetContentRegionMax().x - cross);
    ImGui::PushID(extension.name.c_str());
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0, 0, 0, 0));
    const bool remove = ImGui::SmallButton("\u00d7");
    ImGui::PopStyleColor();
    ImGui::PopID();
    ui::known_as(extension.name + " remove");
    ui::hint("Remove the component");
    if (open) {
      const ui::Scope scope(extension.name);
      for (const Key& key : extension.keys)
        if (!key.alias && found(extension, key)) draw_key(editor, extension, key, have);
    }
    if (remove)
      editor.apply("Remove " + words(extension.name), without_component(editor.state(), have, extension.name));
  }

  void draw_key(Editor& editor, const Extension& extension, const Key& key, const std::vector<NodeId>& ids) {
    const NodeId shown = extension.on_scene ? kNoNode : ids.back();
    const Json value = value_of_key(editor.state(), shown, extension.name, key.name),
               otherwise = default_of_key(extension.name, key.name);
    bool mixed = false;
    for (const NodeId id : ids) mixed |= value_of_key(editor.state(), id, extension.name, key.name) != value;
    std::string hint_text = key.doc;
    if (const std::string range = range_text(key); !range.empty()) hint_text += "\n" + range;
    if (!otherwise.is_null()) hint_text += "\nDefault: " + otherwise.dump();
    if (mixed) hint_text += "\nThe selected nodes have different values.";
    const std::string what = "Set " + words(key.name);
    if (begin_row((words(key.name) + (mixed ? " *" : "")).c_str(), hint_text.c_str(), value != otherwise)) {
      editor.apply("Reset " + words(key.name), with_default(editor.state(), ids, extension.name, key.name));
      return;
    }
    Json next = value;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (key_field(editor, key, next))
      editor.apply(what, with_value(editor.state(), ids, extension.name, key.name, next),
                   extension.name + "." + key.name);
    if (key.name == "error" && ui::button("Measure models\u2026", "What this budget chooses, and from what"))
      app_.show_panel("Error budget");
    if (const std::optional<Note> doubtful = doubt(key, value)) {
      ImGui::GetWindowDrawList()->AddRect(at, {at.x + ImGui::GetContentRegionAvail().x, at.y + ImGui::GetFrameHeight()},
                                          ui::color(ui::palette().warning), ui::px(4));
      ImGui::TextColored(ui::palette().warning, "%s", "Unusual");
      ui::hint(doubtful->message().c_str());
    }
  }

  void draw_light(Editor& editor, const DocumentNode& node) {
    if (!node.node.light) return;
    ui::gap(2);
    if (!ui::section("Light")) return;
    const ui::Scope scope("light");
    Light light = *node.node.light;
    bool changed = false;
    std::string kind = light.kind == Light::Kind::kDirectional ? "directional"
                       : light.kind == Light::Kind::kPoint     ? "point"
                                                               : "spot";
    begin_row("Kind", "Directional: from far away, along the node's -Z. Point: from its origin. Spot: a cone.", false);
    if (ui::combo("kind", kind, {"directional", "point", "spot"})) {
      light.kind = kind == "directional" ? Light::Kind::kDirectional
                   : kind == "point"     ? Light::Kind::kPoint
                                         : Light::Kind::kSpot;
      changed = true;
    }
    double intensity = static_cast<double>(light.intensity);
    begin_row("Intensity", "Lux of a directional light, candela of the others", false);
    if (ui::number("intensity", intensity, 0, 1e6, light.kind == Light::Kind::kDirectional ? "lx" : "cd", true)) {
      light.intensity = static_cast<float>(intensity);
      changed = true;
    }
    begin_row("Colour", "Linear RGB", false);
    changed |= ui::color_field("colour", &light.color.x);
    if (changed) editor.apply("Light", with_light(editor.state(), node.id, light), "light " + std::to_string(node.id));
    if (ui::button("Remove light")) editor.apply("Remove light", with_light(editor.state(), node.id, {}));
  }

  void draw_camera(Editor& editor, const DocumentNode& node) {
    if (!node.node.camera) return;
    ui::gap(2);
    if (!ui::section("Camera")) return;
    const ui::Scope scope("camera");
    Camera camera = *node.node.camera;
    double degrees = glm::degrees(static_cast<double>(camera.yfov));
    begin_row("Field of view", "Vertical", false);
    if (ui::number("field of view", degrees, 1, 170, "\u00b0")) {
      camera.yfov = static_cast<float>(glm::radians(degrees));
      editor.apply("Camera", with_camera(editor.state(), node.id, camera), "camera " + std::to_string(node.id));
    }
    if (ui::button("Remove camera")) editor.apply("Remove camera", with_camera(editor.state(), node.id, {}));
  }

  void draw_add(Editor& editor) {
    ui::gap(ui::kPad);
    if (ui::button("Add component", nullptr, true, 0)) ImGui::OpenPopup("add component");
    if (!ImGui::BeginPopup("add component")) return;
    for (const Extension& each : extension_table()) {
      if (each.on_scene) continue;
      const bool everywhere = std::all_of(editor.selected.begin(), editor.selected.end(),
                                          [&](NodeId id) { return has_component(editor.state(), id, each.name); });
      if (ui::menu_item(words(each.name).c_str(), nullptr, false, !everywhere))
        editor.apply("Add " + words(each.name), with_component(editor.state(), editor.selected, each.name));
      ui::hint(each.doc.c_str());
    }
    const DocumentNode* const node = editor.active_node();
    ImGui::Separator();
    if (ui::menu_item("Light", nullptr, false, node && !node->node.light))
      editor.apply("Add light", with_light(editor.state(), node->id, Light{}));
    if (ui::menu_item("Camera", nullptr, false, node && !node->node.camera))
      editor.apply("Add camera", with_camera(editor.state(), node->id, Camera{}));
    ImGui::EndPopup();
  }

  void draw_scene(Editor& editor) {
    ui::title("Level");
    ui::dim("Nothing is selected: what holds for the whole level.");
    ui::gap(2);
    std::string about = editor.state().about;
    if (search_.empty()) {
      begin_row("About", "What the level shows, in a sentence; lists and the start page say it", false);
      if (ui::text_field("about", about, "what it shows")) {
        State next = editor.state();
        next.about = about;
        editor.apply("About", next, "about");
      }
    }
    for (const Extension& each : extension_table()) {
      if (!each.on_scene) continue;
      const bool present = has_component(editor.state(), kNoNode, each.name);
      ui::gap(2);
      if (!ui::section(words(each.name).c_str())) continue;
      ui::hint(each.doc.c_str());
      const ui::Scope scope(each.name);
      if (!present) {
        if (ui::button(("Add " + each.name).c_str()))
          editor.apply("Add " + words(each.name), with_component(editor.state(), {}, each.name));
        continue;
      }
      for (const Key& key : each.keys)
        if (!key.alias && found(each, key)) draw_key(editor, each, key, {});
    }
  }

  App& app_;
  std::string search_, new_name_;
  NodeId shown_ = kNoNode;
  std::uint64_t name_at_ = 0;
  std::pair<NodeId, dvec3> shown_turn_{kNoNode, {}};
  quat shown_quat_{1, 0, 0, 0};
};

}  // namespace

std::unique_ptr<Panel> make_inspector_panel(App& app) {
  return std::make_unique<InspectorPanel>(app);
}

}  // namespace pliant
