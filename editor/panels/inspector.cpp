// Properties of the selected node: transform, components by the key table, light and camera. Without a selection: the
// scene.
#include <fmt/format.h>

#include <algorithm>

#include "content/keys/extension_table.h"
#include "editor/app/app.h"
#include "editor/panels/automatic.h"
#include "editor/panels/key_fields.h"
#include "editor/panels/light_fields.h"
#include "editor/panels/material_fields.h"
#include "editor/panels/panels.h"
#include "editor/panels/place_fields.h"
#include "editor/panels/property_row.h"
#include "editor/panels/slider_offer.h"
#include "editor/viewport/gizmo_math.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

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
    if (search_.empty()) place_fields_.draw(editor, *active);
    for (const Extension& each : extension_table())
      if (!each.on_scene) draw_component(editor, each);
    if (editor.selected.size() == 1) draw_material_fields(editor, *active, search_, part_);
    if (search_.empty()) {
      draw_light_fields(editor, *active);
      draw_camera_fields(editor, *active);
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
                          metres_text(size.x, 3), metres_text(size.y, 3), metres_text(size.z, 3))
                  .c_str());
    }
  }

  bool found(const Extension& extension, const Key& key) const {
    return matches(search_, key.name) || matches(search_, key.doc) || matches(search_, extension.name);
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
    if (property_row((words(key.name) + (mixed ? " *" : "")).c_str(), hint_text.c_str(), value != otherwise)) {
      editor.apply("Reset " + words(key.name), with_default(editor.state(), ids, extension.name, key.name));
      return;
    }
    Json next = value;
    if (const DocumentNode* const of = editor.state().find(shown); of && value.is_number())
      ui::zero_reads(zero_text(editor.state(), *of, extension.name, key));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (key_field(editor, key, next))
      editor.apply(what, with_value(editor.state(), ids, extension.name, key.name, next),
                   extension.name + "." + key.name);
    ui::zero_reads("");
    offer_slider(editor, extension, key, shown);
    if (key.name == "error" && ui::button("Measure models\u2026", "What this budget chooses, and from what"))
      app_.show_panel("Error budget");
    if (const std::optional<Note> doubtful = doubt(key, value)) {
      ImGui::GetWindowDrawList()->AddRect(at, {at.x + ImGui::GetContentRegionAvail().x, at.y + ImGui::GetFrameHeight()},
                                          ui::color(ui::palette().warning), ui::px(4));
      ImGui::TextColored(ui::palette().warning, "%s", "Unusual");
      ui::hint(doubtful->message().c_str());
    }
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
      property_row("About", "What the level shows, in a sentence; lists and the start page say it", false);
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
  std::size_t part_ = 0;  // of the mesh, whose material is shown
  PlaceFields place_fields_;
};

}  // namespace

std::unique_ptr<Panel> make_inspector_panel(App& app) {
  return std::make_unique<InspectorPanel>(app);
}

}  // namespace pliant
