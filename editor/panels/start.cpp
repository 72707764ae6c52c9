// The start page: unsaved documents, recent files, and the shipped levels.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "editor/app/app.h"
#include "editor/app/files.h"
#include "editor/panels/level_cards.h"
#include "editor/panels/panels.h"
#include "runtime/printable.h"
#include "viewer/ui/widgets.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

class StartPage : public Panel {
 public:
  explicit StartPage(App& app) : app_(app) {}
  const char* name() const override { return "Start"; }
  Place place() const override { return Place::kOver; }

  void draw(Editor& editor) override {
    if (editor.now - looked_ > kLook) look(editor);
    const float wide = ImGui::GetContentRegionAvail().x, left = std::min(ui::px(300), 0.42f * wide);
    ui::gap(ui::kGap);
    ImGui::BeginChild("files", {left, 0});
    files();
    ImGui::EndChild();
    ImGui::SameLine(0, ui::px(ui::kWide));
    ImGui::BeginChild("levels");
    cards_.draw(app_, editor);
    ImGui::EndChild();
  }

 private:
  static constexpr double kLook = 2.0;  // [s] between two checks of the disk
  static constexpr const char* kFirstLevel = "glass_heart";
  struct Recent {
    std::string file;
    bool there = true;
    std::optional<RecoveryCopy> copy;
  };

  void look(Editor& editor) {
    looked_ = editor.now;
    editor.jobs.start("start page", "", [this, files = app_.settings.recent](const Jobs::Stop&) {
      auto recent = std::make_shared<std::vector<Recent>>();
      std::error_code gone;
      for (const std::string& file : files)
        recent->push_back({file, fs::is_regular_file(file, gone), find_recovery(file, state_folder())});
      auto lost = std::make_shared<std::vector<RecoveryCopy>>();
      for (RecoveryCopy& copy : find_recoveries(state_folder()))
        if (copy.file.empty() || std::find(files.begin(), files.end(), copy.file.string()) == files.end())
          lost->push_back(std::move(copy));
      return [this, recent, lost](Editor&) {
        looked_for_ = true;
        recent_ = *recent;
        lost_ = *lost;
      };
    });
  }

  // [point]; in a small window no wider than its column
  static float button_width() { return std::min(160.0f, ImGui::GetContentRegionAvail().x / ui::scale()); }

  void files() {
    ui::title("Pliant");
    ui::dim("Bring an organ's mesh, make it soft, and touch it.");
    ui::gap(ui::kPad);
    if (ui::strong_button("Open organ\u2026", "A level, or any mesh: glTF, OBJ, STL, PLY, OFF, tetrahedra", true,
                          button_width()))
      app_.do_action("file.open");
    ui::gap(ui::kPad);
    unsaved();
    if (recent_.empty()) return first_steps();
    ui::dim("Recent files");
    for (const Recent& each : recent_) {
      const fs::path file = each.file;
      const ui::Scope scope("Recent");
      const std::string shown =
          printable(file.filename().string()) + (each.there ? "" : "  (missing)") + "##" + each.file;
      if (!each.there) ImGui::PushStyleColor(ImGuiCol_Text, ui::palette().faint);
      const bool pressed = ui::selectable(shown.c_str(), false);
      ui::known_as(file.filename().string());
      if (!each.there) ImGui::PopStyleColor();
      ui::hint(printable(each.file).c_str());
      if (pressed && each.there) return app_.open(file);
      if (pressed) {
        app_.editor.say(printable(each.file) + " is not there any more", Severity::kWarning);
        std::erase(app_.settings.recent, each.file);
        looked_ = -1e9;
        return;
      }
    }
  }

  // Shown if no file has been opened yet.
  void first_steps() {
    if (!looked_for_) return;
    ui::dim("New here? Open an organ of your own, or drop its file on this window.");
    const auto first = std::find_if(app_.shipped().begin(), app_.shipped().end(),
                                    [](const fs::path& level) { return level.stem() == kFirstLevel; });
    if (app_.shipped().empty()) return;
    const fs::path level = first != app_.shipped().end() ? *first : app_.shipped().front();
    ui::gap(ui::kGap);
    ui::dim("Or try a level that is ready: open it, press Play, and press on it with the mouse.");
    ui::gap(ui::kGap);
    if (ui::button(fmt::format("Try {}###Try a level", level.stem().string()).c_str(), "Opens it; nothing is changed",
                   true, button_width()))
      app_.open(level);
    ui::known_as("Try a level");
  }

  void unsaved() {
    bool first = true;
    const auto offer = [&](const RecoveryCopy& copy) {
      if (first) ui::dim("Not saved when the editor ended");
      first = false;
      const ui::Scope scope("Unsaved " + copy.title);
      ImGui::PushID(copy.copy.c_str());
      ImGui::AlignTextToFramePadding();
      ImGui::TextColored(ui::palette().warning, "%s", printable(copy.title).c_str());
      ui::hint(printable(copy.file.empty() ? copy.copy.string() : copy.file.string()).c_str());
      if (ui::button("Recover", "Opens it as it was; save it to keep it", true, 90)) app_.files().recover(copy);
      const bool sure = sure_ == copy.copy;
      ui::rows_end_at(ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x);
      ui::beside(ui::kGap, sure ? "Really discard" : "Discard");
      ui::rows_end_at(0);
      if (ui::button(sure ? "Really discard##discard" : "Discard##discard", "It cannot be brought back", true)) {
        if (sure) {
          remove_recovery(copy);
          looked_ = -1e9;
        }
        sure_ = sure ? fs::path() : copy.copy;
      }
      ui::known_as("Discard");
      ImGui::PopID();
    };
    for (const Recent& each : recent_)
      if (each.copy) offer(*each.copy);
    for (const RecoveryCopy& copy : lost_) offer(copy);
    if (!first) ui::gap(ui::kPad);
  }

  App& app_;
  double looked_ = -1e9;  // [s]
  bool looked_for_ = false;
  std::vector<Recent> recent_;
  std::vector<RecoveryCopy> lost_;
  fs::path sure_;
  LevelCards cards_;
};

}  // namespace

std::unique_ptr<Panel> make_start_page(App& app) {
  return std::make_unique<StartPage>(app);
}

}  // namespace pliant
