// The path of a probe or tool: its keys in a table, its depth over time as a curve, and the resulting script.
#include <fmt/format.h>

#include <algorithm>

#include "editor/app/app.h"
#include "editor/core/path_editing.h"
#include "editor/panels/panels.h"
#include "editor/play/record_path.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

constexpr double kWithin = 2e-4;  // [m] tolerance for a recorded path; the Play tab has its own

class PathPanel : public Panel {
 public:
  explicit PathPanel(App& app) : app_(app) {}
  const char* name() const override { return "Path"; }
  Place place() const override { return Place::kRight; }

  void draw(Editor& editor) override {
    const NodeId id = path_node(editor);
    ui::gap();
    if (id == kNoNode) {
      ui::dim("Select a probe or an instrument with a haptic device: its palpation path is made here.");
      return;
    }
    const DocumentNode& node = *editor.state().find(id);
    const ScriptKeys keys = keys_of_node(editor, id);
    ui::title(printable(node.node.name).c_str());
    if (!node.node.device->file.empty())
      ui::dim(("Script " + printable(node.node.device->file) + ", written when the level is saved").c_str());
    if (ui::strong_button("Set keys", "Takes the tool Path: click on the organ, one press after another"))
      app_.take_tool("Path");
    draw_record(editor, node);
    draw_pace(editor);
    if (keys.keys.empty()) {
      ui::dim("No path yet. Take the tool Path and click on the organ.");
      return;
    }
    draw_curve(editor, keys);
    draw_keys(editor, id, keys);
  }

 private:
  // The recorded motion of this device's probes and tools in a run.
  void draw_record(Editor& editor, const DocumentNode& device) {
    if (!app_.play().has_past()) return;
    for (const PlayEffector& each : app_.play().status().effectors) {
      const DocumentNode* const node = editor.state().find(each.name);
      if (!node || device_of(editor.state(), node->id) != device.id) continue;
      ImGui::SameLine();
      if (ui::button("Record from the run", "What it did in the run that was played becomes its path"))
        record_path(editor, app_.play(), each.name, kWithin);
      return;
    }
  }

  void draw_pace(Editor& editor) {
    double depth = editor.path_depth * 1e3, speed = editor.path_speed * 1e3;
    ui::label("Depth", "How deep the next key presses the tip's surface into the organ's");
    ImGui::SameLine(ui::px(90));
    if (ui::number("depth", depth, -50, 50, "mm", false, 110)) editor.path_depth = depth * 1e-3;
    ui::label("Speed", "On the way to the next key");
    ImGui::SameLine(ui::px(90));
    if (ui::number("speed", speed, 0.1, 500, "mm/s", false, 110)) editor.path_speed = speed * 1e-3;
  }

  // Height above the surface over time; the surface is the middle line.
  void draw_curve(const Editor&, const ScriptKeys& keys) {
    const ui::Palette& p = ui::palette();
    ui::gap(2);
    const ImVec2 at = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, ui::px(84));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, ui::color(p.window), ui::px(4));
    double low = 0, high = 0;
    for (const PathKey& key : keys.keys) {
      low = std::min(low, key.height);
      high = std::max(high, key.height);
    }
    const double begin = keys.keys.front().time, length_s = std::max(keys.keys.back().time - begin, 1e-9),
                 span = std::max(high - low, 1e-6);
    const auto place = [&](double time, double height) {
      return ImVec2(at.x + size.x * static_cast<float>(0.03 + 0.94 * (time - begin) / length_s),
                    at.y + size.y * static_cast<float>(0.1 + 0.8 * (high - height) / span));
    };
    list.AddLine(place(begin, 0), place(begin + length_s, 0), ui::color(p.faint), ui::px(1));
    std::vector<ImVec2> points;
    for (int i = 0; i <= 200; ++i) {
      const double t = begin + length_s * i / 200;
      points.push_back(place(t, height_at(keys, t)));
    }
    list.AddPolyline(points.data(), static_cast<int>(points.size()), ui::color(p.depth), 0, ui::px(1.5f));
    for (const PathKey& key : keys.keys)
      list.AddCircleFilled(place(key.time, key.height), ui::px(keys.keys.size() > 30 ? 2 : 3), ui::color(p.accent));
    ImGui::Dummy(size);
    ImGui::PushFont(ui::font(ui::Type::kSmall));
    ui::dim(fmt::format("{:.1f} mm over, {:.1f} mm into the surface; {:.1f} s, {} keys", high * 1e3, -low * 1e3,
                        length_s, keys.keys.size())
                .c_str());
    ImGui::PopFont();
  }

  void draw_keys(Editor& editor, NodeId id, const ScriptKeys& keys) {
    ScriptKeys next = keys;
    bool changed =
        ui::checkbox("Smooth", next.smooth, "Slows down at each turn and never passes beyond a key; else straight");
    std::string what = "Smooth";
    ImGui::SameLine(0, ui::px(ui::kPad));
    if (ui::checkbox(
            "Along the surface", next.along,
            "Between its keys the tip follows the surface, and tools are turned along its normal; else straight "
            "from key to key, without turning")) {
      changed = true;
      what = "Along the surface";
      // Along a surface, heights are of the tip's surface; otherwise of its centre. Convert them so that the keys keep
      // their positions.
      const double radius = tip_of(editor.state(), id).value_or(PathTip{}).radius;
      for (PathKey& key : next.keys)
        if (key.normal != dvec3(0)) key.height += next.along ? -radius : radius;
    }
    for (std::size_t i = 0; i < next.keys.size(); ++i) {
      PathKey& key = next.keys[i];
      ImGui::PushID(static_cast<int>(i));
      const ui::Scope scope("Row " + std::to_string(i + 1));
      ui::label(std::to_string(i + 1).c_str());
      ImGui::SameLine(ui::px(26));
      if (ui::number("time", key.time, 0, 3600, "s", false, 86)) {
        changed = true;
        what = "Time of a key";
      }
      ImGui::SameLine();
      double height = key.height * 1e3;
      if (ui::number("height", height, -100, 1000, "mm", false, 86)) {
        key.height = height * 1e-3;
        changed = true;
        what = "Depth of a key";
      }
      ImGui::SameLine();
      const bool remove = ui::button("\u00d7", "Remove the key");
      if (ImGui::IsItemHovered()) editor.path_key = i;
      ImGui::PopID();
      if (remove) {
        next.keys.erase(next.keys.begin() + static_cast<std::ptrdiff_t>(i));
        set_keys_of_node(editor, id, next, "Remove a key");
        return;
      }
    }
    if (changed) set_keys_of_node(editor, id, next, what, what);
    if (ui::button("Leave", "A last key, up from the surface")) {
      PathKey key = keys.keys.back();
      const double clear = path_clearance(editor, id);
      key.time += (clear - key.height) / editor.path_speed;
      key.height = clear;
      next = keys;
      next.keys.push_back(key);
      set_keys_of_node(editor, id, next, "Leave the surface");
    }
    ImGui::SameLine();
    if (ui::button("Clear", "Removes all keys")) set_keys_of_node(editor, id, {}, "Clear the path");
  }

  App& app_;
};

}  // namespace

std::unique_ptr<Panel> make_path_panel(App& app) {
  return std::make_unique<PathPanel>(app);
}

}  // namespace pliant
