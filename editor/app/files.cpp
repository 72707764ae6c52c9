#include "editor/app/files.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <ctime>

#include "content/level_file.h"
#include "editor/app/app.h"
#include "editor/document/named_files.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

// "today 14:03:20", or with its date.
std::string time_text(fs::file_time_type time) {
  const auto system = std::chrono::time_point_cast<std::chrono::system_clock::duration>(
      time - fs::file_time_type::clock::now() + std::chrono::system_clock::now());
  const std::time_t then = std::chrono::system_clock::to_time_t(system), now = std::time(nullptr);
  std::tm a{}, b{};
  ::localtime_r(&then, &a);
  ::localtime_r(&now, &b);
  const bool today = a.tm_yday == b.tm_yday && a.tm_year == b.tm_year;
  return today ? fmt::format("today {:%H:%M:%S}", a) : fmt::format("{:%Y-%m-%d %H:%M:%S}", a);
}

std::string lower_extension(const fs::path& file) {
  std::string text = file.extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

bool is_level_name(const fs::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".glb" || extension == ".gltf";
}

std::string suggested_name(const Document& document) {
  if (!document.file().empty()) return document.file().filename().string();
  std::string name = document.state().rest->name;
  return (name.empty() ? "untitled" : name) + ".level.glb";
}

Files::Files(App& app, bool native) : autosave(state_folder()), app_(app), native_(native) {
  autosave.interval = app.settings.autosave;
}

void Files::update() {
  autosave.interval = app_.settings.autosave;
  autosave.update(app_.editor);
  // What was recovered stays where it was until a newer copy, or the file itself, has it.
  if (!recovered_.copy.empty() && (autosave.has_copy() || !app_.editor.document.dirty())) {
    const bool same_place = !recovered_.file.empty() && recovered_.copy == recovery_beside(recovered_.file);
    if (!same_place || !app_.editor.document.dirty()) remove_recovery(recovered_);
    recovered_ = {};
  }
  watch();
}

// --- Asking for a file

void Files::choose(const FileWish& wish, std::function<void(const fs::path&)> then) {
  wish_ = wish;
  ++wishes_;
  then_ = std::move(then);
  if (wish_.folder.empty()) {
    std::error_code failed;
    wish_.folder = fs::current_path(failed);
  }
  std::error_code failed;
  wish_.folder = fs::absolute(wish_.folder, failed).lexically_normal();
  if (!native_ || !native_dialog_there()) return app_.show_panel("Files");
  app_.editor.jobs.start("native dialog", "", [this, wish = wish_](const Jobs::Stop& stop) {
    fs::path file;
    const bool came_up = native_dialog(wish, stop, file);
    return [this, file, came_up](Editor&) {
      if (!came_up) {  // no service for it, say
        native_ = false;
        app_.show_panel("Files");
      } else if (!file.empty()) {
        chosen(file);
      }
    };
  });
}

void Files::chosen(const fs::path& file) {
  if (auto then = std::exchange(then_, nullptr)) then(file);
}

// --- Opening

void Files::ask_open() {
  FileWish wish{.title = "Open a level or a mesh", .folder = app_.editor.document.folder()};
  if (wish.folder.empty() && !app_.settings.recent.empty())
    wish.folder = fs::path(app_.settings.recent.front()).parent_path();
  choose(wish, [this](const fs::path& file) { open(file); });
}

void Files::open(const fs::path& file, double unit) {
  app_.leave_document([this, file, unit] {
    std::optional<RecoveryCopy> copy = find_recovery(file, state_folder());
    if (!copy) return load(file, unit);
    const FileStamp saved = stamp_of(file);
    app_.ask(
        {"Changes were not saved when the editor ended",
         {file.filename().string() + " has changes in a copy for recovery:",
          "the copy is of " + time_text(copy->time) +
              (saved.there ? ", the file of " + time_text(saved.time) + "." : "; the file itself is gone.")},
         {{"Recover the changes", "Opens the copy; nothing is written to the file until you save.",
           [this, c = *copy] { recover(c); }},
          {"Open the file", "The copy is kept until you change something.", [this, file, unit] { load(file, unit); }},
          {"Cancel", "", {}}}});
  });
}

void Files::load(const fs::path& file, double unit) {
  app_.editor.jobs.start("open", "Opening " + file.filename().string(), [this, file, unit](const Jobs::Stop&) {
    auto document = std::make_shared<Result<Document>>(Document::open(file, unit));
    return [this, document, file](Editor& to) {
      if (!*document) return to.say(document->error().message(), Severity::kError);
      to.take(std::move(**document));
      to.say("Opened " + file.filename().string());
      app_.settings.used(file);
      (void)app_.settings.save();
    };
  });
}

void Files::recover(const RecoveryCopy& copy) {
  app_.editor.jobs.start("open", "Recovering " + copy.title, [this, copy](const Jobs::Stop&) {
    auto document = std::make_shared<Result<Document>>(Document::recover(copy.copy, copy.file, copy.folder));
    return [this, document, copy](Editor& to) {
      if (!*document) return to.say(document->error().message(), Severity::kError);
      to.take(std::move(**document));
      recovered_ = copy;
      to.say("Recovered " + copy.title + " as it was " + time_text(copy.time) + "; save it to keep it");
      if (!copy.file.empty()) app_.settings.used(copy.file);
    };
  });
}

// --- Saving

bool Files::save() {
  Document& document = app_.editor.document;
  if (document.file().empty()) {
    save_as();
    return false;
  }
  if (Status s = document.save(); !s) {
    app_.editor.say(s.error().message(), Severity::kError);
    return false;
  }
  app_.settings.used(document.file());
  app_.editor.say("Saved " + document.file().filename().string());
  return true;
}

void Files::save_as(std::function<void()> then) {
  ask_name("Save the level as", false, std::move(then));
}

void Files::save_copy() {
  ask_name("Save a copy as", true, {});
}

void Files::ask_name(const char* title, bool copy, std::function<void()> then) {
  const Document& document = app_.editor.document;
  const FileWish wish{.title = title, .save = true, .folder = document.folder(), .name = suggested_name(document)};
  choose(wish, [this, copy, then](const fs::path& chosen) {
    fs::path file = chosen;
    if (!is_level_name(file)) file += ".glb";
    const bool is_own = file == app_.editor.document.file();
    std::error_code gone;
    if (!fs::exists(file, gone) || is_own) return write(file, copy, then);
    // The desktop's dialog has asked already, unless the ending came after it.
    const FileStamp there = stamp_of(file);
    app_.ask({"Replace " + file.filename().string() + "?",
              {"There is a file of this name already, of " + time_text(there.time) + ".",
               "In " + file.parent_path().string()},
              {{"Replace", "What is in it now is lost.", [this, file, copy, then] { write(file, copy, then); }},
               {"Another name", "",
                [this, copy, then] { ask_name(copy ? "Save a copy as" : "Save the level as", copy, then); }},
               {"Cancel", "", {}}}});
  });
}

void Files::write(const fs::path& file, bool copy, const std::function<void()>& then) {
  Editor& editor = app_.editor;
  const fs::path before = editor.document.folder();
  if (Status s = copy ? editor.document.save_copy(file) : editor.document.save_as(file); !s)
    return editor.say(s.error().message(), Severity::kError);
  editor.say((copy ? "Saved a copy as " : "Saved as ") + file.filename().string());
  const auto brought = bring_named_files(editor.state(), before, file.parent_path());
  if (!brought)
    editor.say(brought.error().message(), Severity::kWarning);
  else if (!brought->empty())
    editor.say(fmt::format("Copied what it names, too: {}", fmt::join(*brought, ", ")));
  if (!copy) {
    app_.settings.used(file);
    (void)app_.settings.save();
  }
  if (then) then();
}

void Files::revert() {
  const Document& document = app_.editor.document;
  if (document.file().empty())
    return app_.editor.say("The level has no file yet to go back to; undo instead", Severity::kWarning);
  reload("Revert");
}

void Files::reload(const std::string& what) {
  const fs::path file = app_.editor.document.file();
  const std::uint64_t document = app_.editor.documents;
  app_.editor.jobs.start("open", "Reading " + file.filename().string(), [file, document, what](const Jobs::Stop&) {
    const FileStamp stamp = stamp_of(file);
    auto level = std::make_shared<Result<Level>>(load_level(file));
    return [level, stamp, file, document, what](Editor& to) {
      if (to.documents != document || to.document.file() != file) return;
      if (!*level) return to.say(level->error().message(), Severity::kError);
      to.revert_to(std::move(**level), stamp, what);
      to.say(what == "Revert" ? "Back to the file; undo brings the changes back"
                              : file.filename().string() + " has changed on disk and was read again");
    };
  });
}

void Files::close_in_order() {
  autosave.forget();
  if (!recovered_.copy.empty()) remove_recovery(recovered_);
}

void Files::save_what_can_be() {
  autosave.write_now(app_.editor);
}

// --- Files that other programs change

void Files::watch() {
  Editor& editor = app_.editor;
  constexpr double kEvery = 1.0;  // [s]
  if (editor.now - watched_ < kEvery || asking_ || editor.jobs.running("watch") || editor.jobs.running("open")) return;
  watched_ = editor.now;
  const fs::path folder = editor.document.folder(), file = editor.document.file();
  std::vector<fs::path> paths;
  for (const std::string& name : named_files(editor.state()))
    if (const Result<fs::path> path = confined_path(folder, name); path) paths.push_back(*path);
  if (!file.empty()) paths.push_back(file);
  if (paths.empty()) return;
  editor.jobs.start(
      "watch", "", [this, paths, known = editor.document.file_stamp(), document = editor.documents](const Jobs::Stop&) {
        std::map<fs::path, FileStamp> now;
        for (const fs::path& path : paths) now[path] = stamp_of(path);
        return [this, now, known, document](Editor&) { compare(now, known, document); };
      });
}

void Files::compare(const std::map<fs::path, FileStamp>& now, const FileStamp& known, std::uint64_t document) {
  Editor& editor = app_.editor;
  if (editor.documents != document) return;
  if (seen_document_ != document) {
    seen_.clear();
    seen_document_ = document;
    unsettled_ = {};
  }
  const fs::path file = editor.document.file();
  for (const auto& [path, stamp] : now) {
    if (path == file) continue;
    const auto before = seen_.find(path);
    if (before != seen_.end() && before->second != stamp) {
      editor.say(path.filename().string() + (stamp.there ? " has changed on disk" : " is gone"));
      ++editor.files_read;
      editor.found_at = ~std::uint64_t{0};
    }
    seen_[path] = stamp;
  }
  const auto level = now.find(file);
  if (level == now.end() || !level->second.there || !(known == editor.document.file_stamp()) || level->second == known)
    return;
  if (level->second != unsettled_) {  // once more in a second: it may still be written
    unsettled_ = level->second;
    return;
  }
  if (!editor.document.dirty()) {
    unsettled_ = {};
    return reload("Read again");
  }
  asking_ = true;
  app_.ask({file.filename().string() + " has changed on disk",
            {"Another program has written it " + time_text(level->second.time) + ", and there are changes here, too."},
            {{"Keep mine", "Saving will replace what is on disk.",
              [this] {
                asking_ = false;
                app_.editor.document.accept_file();
              }},
             {"Load theirs", "Undo brings yours back.", [this] {
                asking_ = false;
                app_.editor.document.accept_file();
                reload("Read again");
              }}}});
}

}  // namespace pliant
