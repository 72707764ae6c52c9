// Appearance of the editor, and the interval of recovery copies.
#include <fmt/format.h>

#include "editor/app/navigation.h"
#include "editor/panels/dialog.h"
#include "editor/panels/panels.h"

namespace pliant {
namespace {

class SettingsPanel : public Panel {
 public:
  explicit SettingsPanel(App& app) : app_(app) {}
  const char* name() const override { return "Settings"; }
  Place place() const override { return Place::kOver; }

  void draw(Editor&) override {
    const Dialog dialog(app_, name(), "Settings", {460, 210});
    Settings& s = app_.settings;
    const Settings before = s;
    const auto column = [] { ImGui::SameLine(ui::px(150)); };
    ui::label("Theme");
    column();
    if (ui::choice_button("Dark", !s.light)) s.light = false;
    ImGui::SameLine(0, ui::px(2));
    if (ui::choice_button("Light", s.light, "For bright rooms and projectors")) s.light = true;
    ui::label("Scale");
    column();
    for (const double scale : {0.0, 1.0, 1.25, 1.5, 2.0}) {
      const std::string name = scale == 0.0 ? "Display's" : fmt::format("{:.0f} %", 100 * scale);
      if (ui::choice_button(name.c_str(), s.scale == scale,
                            scale == 0.0 ? "As large as the display asks for" : "Of everything in the window"))
        s.scale = scale;
      ImGui::SameLine(0, ui::px(2));
    }
    ImGui::NewLine();
    ui::label("Mouse", "What moves the view");
    column();
    for (const NavigationRow& row : navigation_rows()) {
      const bool own = &row == navigation_rows().data();
      if (ui::choice_button(row.name, s.navigation == (own ? "" : row.name), row.hint))
        s.navigation = own ? "" : row.name;
      ImGui::SameLine(0, ui::px(2));
    }
    ImGui::NewLine();
    ui::label("Copy for recovery",
              "Of what is not saved, beside the file. It is there after a crash or a loss of power.");
    column();
    bool finished = false;
    ui::number("every", s.autosave, 0.1, 3600, "s", false, 110, &finished);
    if (s.light != before.light || s.scale != before.scale) app_.look_changed();
    if (s.light != before.light || s.scale != before.scale || s.navigation != before.navigation || finished)
      if (const Status saved = s.save(); !saved) app_.editor.say(saved.error().message(), Severity::kWarning);
  }

 private:
  App& app_;
};

}  // namespace

std::unique_ptr<Panel> make_settings_panel(App& app) {
  return std::make_unique<SettingsPanel>(app);
}

}  // namespace pliant
