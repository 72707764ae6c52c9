#include "editor/app/files.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <ctime>

#include "content/level/unit.h"
#include "content/level_file.h"
#include "editor/app/add.h"
#include "editor/app/app.h"
#include "editor/document/named_files.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& file) {
  std::string text = file.extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

}  // namespace

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
  follow_lock();
  autosave.update(app_.editor);
  // A recovered copy is kept until a newer copy or the saved file contains its content.
  if (!recovered_.copy.empty() && (autosave.has_copy() || !app_.editor.document.dirty())) {
    const bool same_place = !recovered_.file.empty() && recovered_.copy == recovery_beside(recovered_.file);
    if (!same_place || !app_.editor.document.dirty()) remove_recovery(recovered_);
    recovered_ = {};
  }
  watch();
}

// --- Asking for a file

void Files::choose(const FileRequest& request, std::function<void(const fs::path&)> then) {
  request_ = request;
  ++requests_;
  then_ = std::move(then);
  if (request_.folder.empty()) {
    std::error_code failed;
    request_.folder = fs::current_path(failed);
  }
  std::error_code failed;
  request_.folder = fs::absolute(request_.folder, failed).lexically_normal();
  if (!native_ || !native_dialog_there()) return app_.show_panel("Files");
  app_.editor.jobs.start("native dialog", "", [this, request = request_](const Jobs::Stop& stop) {
    fs::path file;
    const bool came_up = native_dialog(request, stop, file);
    return [this, file, came_up](Editor&) {
      if (!came_up) {  // for instance, no service for it
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

void Files::ask_open(const fs::path& folder) {
  FileRequest request{.title = "Open a level or a mesh",
                      .folder = folder.empty() ? app_.editor.document.folder() : folder};
  if (request.folder.empty() && !app_.settings.recent.empty())
    request.folder = fs::path(app_.settings.recent.front()).parent_path();
  choose(request, [this](const fs::path& file) { open(file); });
}

void Files::open(const fs::path& file, double unit) {
  app_.leave_document([this, file, unit] {
    ask_who_has(file, [this, file, unit](bool read_only) {
      std::optional<RecoveryCopy> copy = find_recovery(file, state_folder());
      // A copy written by a running editor is not left over from a crash.
      if (!copy || read_only || lock_holder(file)) return load(file, unit, read_only);
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
  });
}

void Files::ask_who_has(const fs::path& file, std::function<void(bool)> then) {
  const std::optional<LockHolder> holder = lock_holder(file);
  if (!holder) return then(false);
  app_.ask({file.filename().string() + " is open in another editor",
            {text_of(*holder) + ".", "Whoever saves last replaces what the other one saved."},
            {{"Open read-only", "Saving asks for another name.", [then] { then(true); }},
             {"Edit it all the same", "Both may save.", [then] { then(false); }},
             {"Cancel", "", {}}}});
}

// Locks the document's file, as soon as no other editor has it locked.
void Files::follow_lock() {
  const Editor& editor = app_.editor;
  const fs::path& file = editor.document.file();
  const bool another = locked_document_ != editor.documents || locked_file_ != file;
  if (!another && (file.empty() || read_only_ || (lock_ && lock_->held()) || editor.now - lock_tried_ < 2.0)) return;
  if (locked_document_ != editor.documents) read_only_ = std::exchange(next_read_only_, false);
  if (another && locked_document_ == editor.documents) read_only_ = false;  // saved elsewhere
  locked_document_ = editor.documents;
  locked_file_ = file;
  lock_tried_ = editor.now;
  lock_.reset();
  autosave.shared = !file.empty() && lock_holder(file).has_value();
  if (file.empty() || read_only_) return;
  lock_ = std::make_unique<FileLock>(file);
  if (lock_->took_over()) app_.editor.say(file.filename().string() + " was left open by an editor that runs no more");
}

void Files::load(const fs::path& file, double unit, bool read_only, std::function<void(const Error&)> failed) {
  app_.editor.jobs.start(
      kOpenJob, "Opening " + file.filename().string(), [this, file, unit, read_only, failed](const Jobs::Stop&) {
        auto document = std::make_shared<Result<Document>>(Document::open(file, unit));
        return [this, document, file, read_only, failed](Editor& to) {
          if (!*document && failed) return failed(document->error());
          if (!*document) return to.say(document->error().message(), Severity::kError);
          to.take(std::move(**document));
          next_read_only_ = read_only;
          to.say("Opened " + file.filename().string() + (read_only ? ", read-only: saving asks for another name" : ""));
          app_.settings.used(file);
          (void)app_.settings.save();
        };
      });
}

void Files::add(const fs::path& file) {
  const std::string name = printable(file.filename().string());
  app_.editor.jobs.start("add " + file.string(), "Reading " + name, [this, file, name](const Jobs::Stop&) {
    auto level = std::make_shared<Result<Level>>(load_level(file));
    return [this, level, name](Editor& to) {
      if (!*level) return to.say(level->error().message(), Severity::kError);
      const Box box = bounds(**level);
      if ((*level)->has_pliant() || unit_hint(box).empty()) return void(add_level(to, name, **level, 1.0));
      Question unit{fmt::format("{} is {:.3g} m across. What is one unit of it?", name, box.diagonal()), {}, {}};
      for (const auto& [word, metres] : {std::pair{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}})
        unit.answers.push_back(
            {word, "", [this, level, name, metres = metres] { add_level(app_.editor, name, **level, metres); }});
      unit.answers.push_back({"Cancel", "", {}});
      app_.ask(std::move(unit));
    };
  });
}

void Files::ask_add() {
  choose({.title = "Add a mesh or a level", .folder = app_.editor.document.folder()},
         [this](const fs::path& file) { add(file); });
}

void Files::give_up_opening() {
  const std::optional<Jobs::Progress> opening = app_.editor.jobs.progress(kOpenJob);
  if (!opening) return;
  app_.editor.jobs.cancel(kOpenJob);
  app_.editor.say("Given up: " + opening->what);
}

void Files::recover(const RecoveryCopy& copy) {
  app_.editor.jobs.start(kOpenJob, "Recovering " + copy.title, [this, copy](const Jobs::Stop&) {
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
  if (document.file().empty() || read_only_) {
    if (read_only_) app_.editor.say(document.title() + " was opened read-only; save it under another name");
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
  const FileRequest request{
      .title = title, .save = true, .folder = document.folder(), .name = suggested_name(document)};
  choose(request, [this, copy, then](const fs::path& chosen) {
    fs::path file = chosen;
    if (!is_level_name(file)) file += ".glb";
    const bool is_own = file == app_.editor.document.file() && !read_only_;
    std::error_code gone;
    if (!fs::exists(file, gone) || is_own) return write(file, copy, then);
    const std::optional<LockHolder> holder = lock_holder(file);
    // The desktop's dialog has already asked, unless the extension was added after it.
    const FileStamp there = stamp_of(file);
    app_.ask({"Replace " + file.filename().string() + "?",
              {"There is a file of this name already, of " + time_text(there.time) + ".",
               holder ? "It is open in another editor: " + text_of(*holder) : "In " + file.parent_path().string()},
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
  app_.editor.jobs.start(kOpenJob, "Reading " + file.filename().string(), [file, document, what](const Jobs::Stop&) {
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
  lock_.reset();
  if (!recovered_.copy.empty()) remove_recovery(recovered_);
}

void Files::save_what_can_be() {
  autosave.write_now(app_.editor);
}

}  // namespace pliant
