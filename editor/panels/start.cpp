// The first page: files that were open before, and the levels that ship.
#include <fmt/format.h>

#include <filesystem>

#include "editor/app/app.h"
#include "editor/panels/panels.h"
#include "editor/ui/widgets.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

class StartPage : public Panel {
 public:
  explicit StartPage(App& app) : app_(app) {}
  const char* name() const override { return "Start"; }
  Place place() const override { return Place::kOver; }

  void draw(Editor&) override {
    ui::gap(ui::kWide);
    ui::title("Pliant");
    ui::dim("Bring an organ's mesh, make it soft, and touch it.");
    ui::gap(ui::kPad);
    if (ui::strong_button("Open a file\u2026", "A level, or any mesh: glTF, OBJ, STL, PLY, OFF, tetrahedra", true, 180))
      app_.do_action("file.open");
    ui::gap(ui::kPad);
    if (!app_.settings.recent.empty()) ui::dim("Recent files");
    for (const std::string& file : app_.settings.recent)
      if (ui::selectable(printable(file).c_str(), false)) {
        app_.open(file);
        break;
      }
  }

 private:
  App& app_;
};

}  // namespace

std::unique_ptr<Panel> make_start_page(App& app) {
  return std::make_unique<StartPage>(app);
}

}  // namespace pliant
