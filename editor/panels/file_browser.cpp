// The built-in file browser: folders are read in the background, a path can be typed, hidden files are shown on
// request.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "editor/app/files.h"
#include "editor/panels/dialog.h"
#include "editor/panels/folder_list.h"
#include "editor/panels/panels.h"
#include "runtime/printable.h"
#include "viewer/ui/fonts.h"
#include "viewer/ui/seen.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

class FileBrowser : public Panel {
 public:
  explicit FileBrowser(App& app) : app_(app) {}
  const char* name() const override { return "Files"; }
  Place place() const override { return Place::kOver; }

  void draw(Editor& editor) override {
    const FileRequest& request = app_.files().request();
    if (app_.files().requests() != of_) {  // another request
      of_ = app_.files().requests();
      name_ = request.name;
      begins_ = true;
      go(editor, request.folder);
    }
    if (!(filter_ == read_)) read(editor);
    const Dialog dialog(app_, name(), request.title.c_str(), {820, 560});
    if (dialog.closed()) return app_.files().given_up();
    path_row(editor);
    ui::gap(2);
    const float below = ui::px(request.save ? 76 : 40);
    ImGui::BeginChild("places", {ui::px(200), -below});
    places(editor);
    ImGui::EndChild();
    ImGui::SameLine();
    // Arrow keys move the selection, letters search by name.
    ImGui::BeginChild("entries", {0, -below}, false, ImGuiWindowFlags_NoNavInputs);
    if (begins_ && !request.save) ImGui::SetWindowFocus();
    if (ImGui::IsWindowFocused() && !ImGui::GetIO().WantTextInput) keys(editor);
    entries(editor, request);
    ImGui::EndChild();
    ui::gap(2);
    last_row(editor, request);
    begins_ = false;
    // Enter confirms the dialog, whatever has the focus.
    const bool enter = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false) ||
                       ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_KeyPadEnter), false);
    const std::string& chosen = request.save && !list_.on_folder() ? name_ : list_.selected();
    if (enter && !ImGui::IsAnyItemActive() && !ui::keyboard_has_focus() && !chosen.empty() &&
        ImGui::IsWindowFocused(ImGuiFocusedFlags_RootAndChildWindows))
      accept(editor, folder_ / chosen);
  }

 private:
  void go(Editor& editor, const fs::path& folder) {
    folder_ = folder.lexically_normal();
    if (!folder_.has_filename() && folder_.has_parent_path() && folder_ != folder_.root_path())
      folder_ = folder_.parent_path();
    typed_ = folder_.string();
    filter_.part.clear();
    list_.select_none();
    read(editor);
  }

  void read(Editor& editor) {
    read_ = filter_;
    list_.show(nullptr);
    editor.jobs.start("folder", "Reading the folder",
                      [this, folder = folder_, filter = filter_](const Jobs::Stop& stop) {
                        auto listing = std::make_shared<FolderListing>(read_folder(folder, filter, stop));
                        return [this, listing](Editor&) { list_.show(listing); };
                      });
  }

  void keys(Editor& editor) {
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Backspace)) && folder_.has_relative_path())
      return go(editor, folder_.parent_path());
    const FolderEntry* const entry = list_.take_keys();
    if (entry && app_.files().request().save && !entry->folder) name_ = entry->name;
  }

  void entries(Editor& editor, const FileRequest& request) {
    bool twice = false;
    const FolderEntry* const entry = list_.draw(twice);
    if (!entry) return;
    const fs::path path = folder_ / entry->name;
    if (entry->folder) return go(editor, path);
    if (request.save) name_ = entry->name;
    if (twice) choose(path);
  }

  void accept(Editor& editor, const fs::path& path) {
    std::error_code failed;
    if (fs::is_directory(path, failed)) return go(editor, path);
    choose(path);
  }

  void path_row(Editor& editor) {
    if (ui::button("Up", "The folder above", folder_.has_relative_path())) return go(editor, folder_.parent_path());
    ImGui::SameLine();
    const bool entered = ui::text_field("Path", typed_, "A folder or a file", -1, ImGuiInputTextFlags_EnterReturnsTrue);
    if (!entered) return;
    fs::path path = typed_;
    if (typed_.starts_with("~/"))
      if (const char* home = std::getenv("HOME")) path = fs::path(home) / typed_.substr(2);
    if (path.is_relative()) path = folder_ / path;
    std::error_code failed;
    if (fs::is_directory(path, failed)) return go(editor, path);
    if (app_.files().request().save || fs::is_regular_file(path, failed)) return choose(path);
    editor.say(printable(path.string()) + " is not there", Severity::kWarning);
  }

  void places(Editor& editor) {
    const auto place = [&](const std::string& shown, const fs::path& folder) {
      if (!folder.empty() && ui::selectable(shown.c_str(), folder == folder_)) go(editor, folder);
      if (!folder.empty()) ui::hint(printable(folder.string()).c_str());
    };
    ui::dim("Places");
    if (const char* home = std::getenv("HOME")) place("Home", home);
    place("This document's", editor.document.folder());
    if (!app_.shipped().empty()) place("Shipped levels", app_.shipped().front().parent_path());
    ui::gap(ui::kGap);
    ui::dim("Recent");
    if (!app_.files().request().save) {
      for (const std::string& file : app_.settings.recent) {
        const std::string shown = printable(fs::path(file).filename().string()) + "##recent" + file;
        if (ui::selectable(shown.c_str(), false)) return choose(file);
        ui::hint(printable(file).c_str());
      }
      return;
    }
    std::vector<fs::path> seen;
    for (const std::string& file : app_.settings.recent) {
      const fs::path folder = fs::path(file).parent_path();
      if (std::find(seen.begin(), seen.end(), folder) != seen.end()) continue;
      seen.push_back(folder);
      place(printable(folder.filename().string()) + "##folder" + folder.string(), folder);
    }
  }

  void last_row(Editor& editor, const FileRequest& request) {
    if (request.save) {
      ui::label("Name");
      ImGui::SameLine(ui::px(70));
      if (begins_) ImGui::SetKeyboardFocusHere();
      if (ui::text_field("Name", name_, "name.level.glb", -1,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll) &&
          !name_.empty())
        return accept(editor, folder_ / name_);
    }
    ui::text_field("Filter", filter_.part, "A part of the name", 180);
    ImGui::SameLine();
    ui::checkbox("All kinds", filter_.all, "Files that cannot be opened, too");
    ImGui::SameLine();
    ui::checkbox("Hidden", filter_.hidden, "Names that begin with a dot, too");
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ui::px(110));
    const std::string chosen = request.save ? name_ : list_.selected();
    if (ui::strong_button(request.save ? "Save" : "Open", nullptr, !chosen.empty(), 110))
      accept(editor, folder_ / chosen);
  }

  void choose(const fs::path& file) {
    app_.close_panel(name());
    app_.files().chosen(file);
  }

  App& app_;
  std::uint64_t of_ = 0;
  fs::path folder_;
  std::string typed_, name_;
  FolderFilter filter_, read_;
  bool begins_ = false;  // just opened: sets the initial focus
  FolderList list_;
};

}  // namespace

std::unique_ptr<Panel> make_file_browser(App& app) {
  return std::make_unique<FileBrowser>(app);
}

}  // namespace pliant
