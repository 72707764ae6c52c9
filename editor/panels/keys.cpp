// All actions and their key bindings, which can be changed: F1.
#include "viewer/window/keys.h"

#include <fmt/format.h>

#include "editor/panels/dialog.h"
#include "editor/panels/panels.h"

namespace pliant {
namespace {

class KeysPanel : public Panel {
 public:
  explicit KeysPanel(App& app) : app_(app) {}
  const char* name() const override { return "Keys"; }
  Place place() const override { return Place::kOver; }

  void draw(Editor&) override {
    const Dialog dialog(app_, name(), "Keys", {620, 640}, app_.rebinding.empty());
    if (dialog.closed()) {
      app_.rebinding.clear();
      conflict_.reset();
    }
    take_new_keys();
    ui::text_field("Search", search_, "Search what can be done", 280);
    ImGui::SameLine();
    if (ui::button("Reset all", "Every action has its first keys again", !app_.settings.keys.empty())) {
      app_.settings.keys.clear();
      conflict_.reset();
      (void)app_.settings.save();
    }
    notice();
    ui::gap(2);
    ImGui::BeginChild("table");
    std::string group;
    for (const Action& action : app_.actions()) {
      if (!matches(action)) continue;
      if (action.group != group) {
        group = action.group;
        ui::gap(ui::kGap);
        ImGui::PushFont(ui::font(ui::Type::kStrong));
        ImGui::TextUnformatted(group.c_str());
        ImGui::PopFont();
      }
      row(action);
    }
    if (search_.empty()) mouse();
    ImGui::EndChild();
  }

 private:
  struct Conflict {
    std::string id, keys, other;  // action ids
  };

  bool matches(const Action& action) const {
    const auto lower = [](std::string text) {
      for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return text;
    };
    return search_.empty() ||
           lower(action.label + " " + app_.keys_of(action)).find(lower(search_)) != std::string::npos;
  }

  const Action* action(const std::string& id) const {
    for (const Action& each : app_.actions())
      if (each.id == id) return &each;
    return nullptr;
  }

  void bind(const std::string& id, const std::string& keys) {
    if (const Action* of = action(id); of && of->keys == keys)
      app_.settings.keys.erase(id);
    else
      app_.settings.keys[id] = keys;
    (void)app_.settings.save();
  }

  void take_new_keys() {
    if (app_.rebinding.empty() || app_.rebound.empty()) return;
    const std::string id = std::exchange(app_.rebinding, {}), keys = std::exchange(app_.rebound, {});
    conflict_.reset();
    if (keys == "Esc") return;
    for (const Action& each : app_.actions())
      if (each.id != id && app_.keys_of(each) == keys) {
        conflict_ = {id, keys, each.id};
        return;
      }
    bind(id, keys);
  }

  void notice() {
    if (!conflict_) {
      ui::dim(app_.rebinding.empty() ? "Click the keys of an action to give it others."
                                     : "Press the new keys now; Esc leaves them as they are.");
      return;
    }
    const Action *wanted = action(conflict_->id), *other = action(conflict_->other);
    if (!wanted || !other) return conflict_.reset();
    ImGui::PushStyleColor(ImGuiCol_Text, ui::palette().warning);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(fmt::format("{} is {} already.", conflict_->keys, other->label).c_str());
    ImGui::PopStyleColor();
    ui::known_as("Conflict");
    ImGui::SameLine();
    if (ui::button("Take it", "The other action is left without keys")) {
      bind(other->id, "");
      bind(wanted->id, conflict_->keys);
      return conflict_.reset();
    }
    ImGui::SameLine();
    if (ui::button("Leave it")) conflict_.reset();
  }

  void row(const Action& each) {
    const ui::Scope scope(each.id);
    ImGui::PushID(each.id.c_str());
    const bool waits = app_.rebinding == each.id, changed = app_.settings.keys.contains(each.id);
    ImGui::AlignTextToFramePadding();
    ImGui::Indent(ui::px(ui::kPad));
    ImGui::TextUnformatted(each.label.c_str());
    ImGui::Unindent(ui::px(ui::kPad));
    const float right = ImGui::GetWindowContentRegionMax().x;
    const std::string keys = app_.keys_of(each);
    ImGui::SameLine(right - ui::px(240));
    const std::string shown = (waits ? "press keys \u2026" : keys.empty() ? "none" : keys) + "##keys";
    if (ui::choice_button(shown.c_str(), waits, "Click, then press the new keys")) {
      app_.rebinding = waits ? "" : each.id;
      app_.rebound.clear();
      conflict_.reset();
    }
    ui::known_as("keys");
    if (changed) {
      ImGui::SameLine(right - ui::px(70));
      if (ui::button("Reset", fmt::format("Back to {}", each.keys.empty() ? "none" : each.keys).c_str(), true, 70)) {
        app_.settings.keys.erase(each.id);
        (void)app_.settings.save();
      }
    }
    ImGui::PopID();
  }

  static void mouse() {
    ui::gap(ui::kGap);
    ImGui::PushFont(ui::font(ui::Type::kStrong));
    ImGui::TextUnformatted("Mouse, over the picture; left presses what is played");
    ImGui::PopFont();
    const auto line = [](const char* how, const char* words) {
      ImGui::Indent(ui::px(ui::kPad));
      ImGui::TextUnformatted(words);
      ImGui::Unindent(ui::px(ui::kPad));
      ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ui::px(240));
      ImGui::TextColored(ui::palette().dim, "%s", how);
    };
    line("Left click; with Shift or Ctrl one more", "select");
    line("Double click in the scene tree", "bring into view");
    for (const MouseRow& row : mouse_rows()) line(row.how, row.words);
  }

  App& app_;
  std::string search_;
  std::optional<Conflict> conflict_;
};

}  // namespace

std::unique_ptr<Panel> make_keys_page(App& app) {
  return std::make_unique<KeysPanel>(app);
}

}  // namespace pliant
