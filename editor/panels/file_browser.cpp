// The built-in file browser: folders are read in the background, a path can be typed, hidden files are shown on
// request.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "content/openable.h"
#include "editor/app/files.h"
#include "editor/panels/dialog.h"
#include "editor/panels/panels.h"
#include "editor/ui/fonts.h"
#include "editor/ui/seen.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostEntries = 5000;  // per folder; beyond it, the user types a part of the name

struct FolderEntry {
  std::string name, shown;
  bool folder = false;
  std::uintmax_t size = 0;
};
struct Listing {
  std::vector<FolderEntry> entries;  // folders first, by name
  std::size_t left_out = 0;
  std::string fault;
};

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool opens(const fs::path& name) {
  return has_ending(name, openable_endings());
}

struct Filter {
  bool hidden = false, all = false, levels_only = false;
  std::string part;
  bool operator==(const Filter&) const = default;
};

Listing read_folder(const fs::path& folder, const Filter& filter, const Jobs::Stop& stop) {
  Listing out;
  std::error_code failed;
  const std::string part = lower_case(filter.part);
  auto it = fs::directory_iterator(folder, fs::directory_options::none, failed);
  if (failed) {
    out.fault = fs::exists(folder) ? "cannot be read (" + failed.message() + ")" : "is not there";
    return out;
  }
  for (; it != fs::directory_iterator() && !stop; it.increment(failed)) {
    if (failed) break;
    FolderEntry entry;
    entry.name = it->path().filename().string();
    if (!filter.hidden && entry.name.starts_with('.')) continue;
    if (!part.empty() && lower_case(entry.name).find(part) == std::string::npos) continue;
    std::error_code gone;
    entry.folder = it->is_directory(gone);
    if (!entry.folder && (!it->is_regular_file(gone) || (!filter.all && !opens(entry.name)))) continue;
    if (out.entries.size() >= kMostEntries) {
      ++out.left_out;
      continue;
    }
    if (!entry.folder) entry.size = it->file_size(gone);
    entry.shown = printable(entry.name);
    out.entries.push_back(std::move(entry));
  }
  std::sort(out.entries.begin(), out.entries.end(), [](const FolderEntry& a, const FolderEntry& b) {
    return a.folder != b.folder ? a.folder : lower_case(a.name) < lower_case(b.name);
  });
  return out;
}

std::string size_text(std::uintmax_t bytes) {
  const auto b = static_cast<double>(bytes);
  return bytes < 1000      ? fmt::format("{} B", bytes)
         : bytes < 1000000 ? fmt::format("{:.0f} kB", b / 1e3)
                           : fmt::format("{:.1f} MB", b / 1e6);
}

class FileBrowser : public Panel {
 public:
  explicit FileBrowser(App& app) : app_(app) {}
  const char* name() const override { return "Files"; }
  Place place() const override { return Place::kOver; }

  void draw(Editor& editor) override {
    const FileWish& wish = app_.files().wish();
    if (app_.files().wishes() != of_) {  // another request
      of_ = app_.files().wishes();
      name_ = wish.name;
      begins_ = true;
      go(editor, wish.folder);
    }
    if (!(filter_ == read_)) read(editor);
    const Dialog dialog(app_, name(), wish.title.c_str(), {820, 560});
    if (dialog.closed()) return app_.files().given_up();
    path_row(editor);
    ui::gap(2);
    const float below = ui::px(wish.save ? 76 : 40);
    ImGui::BeginChild("places", {ui::px(200), -below});
    places(editor);
    ImGui::EndChild();
    ImGui::SameLine();
    // Arrow keys move the selection, letters search by name.
    ImGui::BeginChild("entries", {0, -below}, false, ImGuiWindowFlags_NoNavInputs);
    if (begins_ && !wish.save) ImGui::SetWindowFocus();
    if (ImGui::IsWindowFocused() && !ImGui::GetIO().WantTextInput) keys(editor);
    entries(editor, wish);
    ImGui::EndChild();
    ui::gap(2);
    last_row(editor, wish);
    begins_ = false;
    // Enter confirms the dialog, whatever has the focus.
    const bool enter = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false) ||
                       ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_KeyPadEnter), false);
    const std::string& chosen = wish.save && !entered_folder_ ? name_ : selected_;
    if (enter && !ImGui::IsAnyItemActive() && !ui::keyboard_leads() && !chosen.empty() &&
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
    selected_.clear();
    entered_folder_ = false;
    read(editor);
  }

  void read(Editor& editor) {
    read_ = filter_;
    listing_.reset();
    editor.jobs.start("folder", "Reading the folder",
                      [this, folder = folder_, filter = filter_](const Jobs::Stop& stop) {
                        auto listing = std::make_shared<Listing>(read_folder(folder, filter, stop));
                        return [this, listing](Editor&) { listing_ = listing; };
                      });
  }

  void keys(Editor& editor) {
    const auto pressed = [](ImGuiKey_ key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
    if (pressed(ImGuiKey_Backspace) && folder_.has_relative_path()) return go(editor, folder_.parent_path());
    if (!listing_ || listing_->entries.empty()) return;
    const auto& all = listing_->entries;
    const auto here = std::find_if(all.begin(), all.end(), [&](const FolderEntry& e) { return e.name == selected_; });
    const auto last = static_cast<std::ptrdiff_t>(all.size()) - 1;
    std::ptrdiff_t to = here == all.end() ? -1 : here - all.begin();
    const std::ptrdiff_t before = to;
    if (pressed(ImGuiKey_DownArrow)) ++to;
    if (pressed(ImGuiKey_UpArrow)) to = std::max<std::ptrdiff_t>(to - 1, 0);
    if (pressed(ImGuiKey_PageDown)) to += 15;
    if (pressed(ImGuiKey_PageUp)) to = std::max<std::ptrdiff_t>(to - 15, 0);
    if (pressed(ImGuiKey_Home)) to = 0;
    if (pressed(ImGuiKey_End)) to = last;
    std::string letter;
    for (const ImWchar c : ImGui::GetIO().InputQueueCharacters)
      if (c > 32 && c < 127) letter = std::string(1, static_cast<char>(c));
    if (!letter.empty())
      for (std::ptrdiff_t i = 1; i <= last + 1; ++i) {
        const std::ptrdiff_t at = (std::max<std::ptrdiff_t>(to, -1) + i) % (last + 1);
        if (!lower_case(all[static_cast<std::size_t>(at)].name).starts_with(lower_case(letter))) continue;
        to = at;
        break;
      }
    to = std::min(to, last);
    if (to == before || to < 0) return;
    const FolderEntry& entry = all[static_cast<std::size_t>(to)];
    selected_ = entry.name;
    entered_folder_ = entry.folder;
    if (app_.files().wish().save && !entry.folder) name_ = entry.name;
    ImGui::SetScrollY(static_cast<float>(to) * ImGui::GetTextLineHeightWithSpacing() - 0.5f * ImGui::GetWindowHeight());
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
    if (app_.files().wish().save || fs::is_regular_file(path, failed)) return choose(path);
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
    if (!app_.files().wish().save) {
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

  void entries(Editor& editor, const FileWish& wish) {
    if (!listing_) return ui::dim("Reading \u2026");
    if (!listing_->fault.empty()) return ui::dim(("This folder " + listing_->fault).c_str());
    if (listing_->entries.empty()) ui::dim("Nothing here that can be opened.");
    std::optional<fs::path> folder, file;
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(listing_->entries.size()));
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const FolderEntry& entry = listing_->entries[static_cast<std::size_t>(i)];
        ImGui::PushID(i);
        ui::draws(entry.shown);
        const bool pressed =
            ImGui::Selectable("##entry", selected_ == entry.name,
                              ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_AllowItemOverlap);
        ui::known_as(entry.name);
        ImGui::SameLine(ui::px(ui::kGap));
        if (entry.folder) {
          ImGui::TextColored(ui::palette().accent, "%s/", entry.shown.c_str());
        } else {
          ImGui::TextUnformatted(entry.shown.c_str());
          ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ui::px(80));
          ImGui::TextColored(ui::palette().faint, "%s", size_text(entry.size).c_str());
        }
        ImGui::PopID();
        if (!pressed) continue;
        if (entry.folder) {
          folder = folder_ / entry.name;
        } else {
          selected_ = entry.name;
          entered_folder_ = false;
          if (wish.save) name_ = entry.name;
          if (ImGui::IsMouseDoubleClicked(0)) file = folder_ / entry.name;
        }
      }
    if (listing_->left_out > 0)
      ui::dim(fmt::format("\u2026 and {} more; type a part of the name above the list.", listing_->left_out).c_str());
    if (folder) return go(editor, *folder);
    if (file) choose(*file);
  }

  void last_row(Editor& editor, const FileWish& wish) {
    if (wish.save) {
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
    const std::string chosen = wish.save ? name_ : selected_;
    if (ui::strong_button(wish.save ? "Save" : "Open", nullptr, !chosen.empty(), 110)) accept(editor, folder_ / chosen);
  }

  void choose(const fs::path& file) {
    app_.close_panel(name());
    app_.files().chosen(file);
  }

  App& app_;
  std::uint64_t of_ = 0;
  fs::path folder_;
  std::string typed_, name_, selected_;
  Filter filter_, read_;
  bool begins_ = false;                     // just opened: sets the initial focus
  bool entered_folder_ = false;             // what is selected is a folder
  std::shared_ptr<const Listing> listing_;  // null: being read
};

}  // namespace

std::unique_ptr<Panel> make_file_browser(App& app) {
  return std::make_unique<FileBrowser>(app);
}

}  // namespace pliant
