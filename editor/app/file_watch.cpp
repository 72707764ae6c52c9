// Files that other programs change while the editor has them: scripts, pictures, buffers, the level, shaders.
#include "content/files/file_io.h"
#include "content/files/image.h"
#include "editor/app/app.h"
#include "editor/app/files.h"
#include "editor/document/named_files.h"
#include "systems/visual/gpu/shader_source.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

}  // namespace

void Files::watch() {
  Editor& editor = app_.editor;
  constexpr double kEvery = 1.0;  // [s]
  if (editor.now - watched_ < kEvery || asking_ || editor.jobs.running("watch") || editor.jobs.running(kOpenJob))
    return;
  watched_ = editor.now;
  const fs::path folder = editor.document.folder(), file = editor.document.file();
  Watches all;
  const auto add = [&](const std::vector<std::string>& names, Watched kind) {
    for (const std::string& name : names)
      if (const Result<fs::path> path = confined_path(folder, name); path) all[*path] = {kind, name, {}};
  };
  add(named_files(editor.state()), Watched::kNamed);
  std::vector<std::string> scripts;
  for (const auto& each : editor.state().nodes)
    if (each->node.device && each->node.device->driver == DriverKind::kScript)
      scripts.push_back(each->node.device->file);
  add(scripts, Watched::kScript);
  const OwnFiles own = own_files(editor.state());
  add(own.pictures, Watched::kPicture);
  add(own.buffers, Watched::kBuffer);
  if (!file.empty()) all[file] = {Watched::kLevel, "", {}};
  editor.jobs.start("watch", "",
                    [this, all, known = editor.document.file_stamp(), document = editor.documents](const Jobs::Stop&) {
                      Watches now = all;
                      std::error_code gone;  // or no folder is set
                      for (const auto& entry : fs::directory_iterator(gpu::shader_folder(), gone))
                        now[entry.path()] = {Watched::kShader, "", {}};
                      for (auto& [path, watch] : now) watch.stamp = stamp_of(path);
                      return [this, now, known, document](Editor&) { compare(now, known, document); };
                    });
}

void Files::read_script_again(const std::string& name, const fs::path& path) {
  app_.editor.jobs.start(
      "read " + name, "Reading " + name, [this, name, path, document = app_.editor.documents](const Jobs::Stop&) {
        auto keys = std::make_shared<Result<ScriptKeys>>(load_keys(path));
        return [this, name, keys, document](Editor& to) {
          if (to.documents != document) return;
          if (!*keys) return to.say(keys->error().message(), Severity::kWarning);
          if (to.document.is_on_disk(name, **keys)) return;  // written by this editor
          const State before = to.state();
          const bool taken = to.document.script_read_again(name, **keys);
          ++to.files_read;
          for (const auto& each : to.on_change) each(before, to.state());
          if (taken) return to.say(name + " has changed on disk and was read again");
          asking_ = true;
          app_.ask({name + " has changed on disk",
                    {"Another program has written the path, and it was changed here, too."},
                    {{"Keep mine", "Saving will replace what is on disk.", [this] { asking_ = false; }},
                     {"Load theirs", "Undo brings yours back.", [this, name, keys] {
                        asking_ = false;
                        Editor& editor = app_.editor;
                        for (const auto& each : editor.state().nodes)
                          if (each->node.device && each->node.device->file == name) {
                            editor.apply("Read again", with_script(editor.state(), each->id, name, **keys));
                            break;
                          }
                      }}}});
        };
      });
}

void Files::read_picture_again(const std::string& name, const fs::path& path) {
  app_.editor.jobs.start(
      "read " + name, "Reading " + name,
      [name, path, document = app_.editor.documents](const Jobs::Stop&) -> std::function<void(Editor&)> {
        const Result<Bytes> bytes = read_file(path);
        auto encoded = std::make_shared<const Bytes>(bytes ? *bytes : Bytes());
        auto image = std::make_shared<Result<Image>>(bytes ? decode_image(*bytes, name) : Result<Image>(bytes.error()));
        return [name, encoded, image, document](Editor& to) {
          if (to.documents != document) return;
          if (!*image) return to.say(image->error().message(), Severity::kWarning);
          const State before = to.state();
          const std::uint64_t revision = to.document.revision();
          to.document.picture_read_again(name, **image, *encoded);
          if (to.document.revision() == revision) return;  // unchanged
          for (const auto& each : to.on_change) each(before, to.state());
          to.say(name + " has changed on disk and was read again");
        };
      });
}

void Files::compare(const Watches& now, const FileStamp& known, std::uint64_t document) {
  Editor& editor = app_.editor;
  if (editor.documents != document) return;
  const bool written_here = !(seen_level_ == known);  // saving also writes its buffers
  seen_level_ = known;
  if (seen_document_ != document) {
    seen_.clear();
    seen_document_ = document;
    unsettled_ = {};
  }
  const fs::path file = editor.document.file();
  bool shaders = false, buffers = false;
  for (const auto& [path, watch] : now) {
    if (watch.kind == Watched::kLevel) continue;
    const auto before = seen_.find(path);
    const bool changed = before != seen_.end() && before->second != watch.stamp;
    seen_[path] = watch.stamp;
    if (!changed) continue;
    if (watch.kind == Watched::kShader) {
      shaders = true;
    } else if (watch.kind == Watched::kBuffer) {
      buffers = buffers || (!written_here && watch.stamp.there);
    } else if (watch.stamp.there && watch.kind == Watched::kScript) {
      read_script_again(watch.name, path);
    } else if (watch.stamp.there && watch.kind == Watched::kPicture) {
      read_picture_again(watch.name, path);
    } else {
      editor.say(path.filename().string() + (watch.stamp.there ? " has changed on disk" : " is gone"));
      ++editor.files_read;
      editor.found_at = ~std::uint64_t{0};
    }
  }
  if (shaders) app_.stage().reload_shaders();
  if (shaders) editor.say("Shaders have changed on disk and are compiled again");
  if (buffers && !editor.document.dirty()) return reload("Read again");
  if (buffers) editor.say("The level's meshes have changed on disk; File, Revert reads them", Severity::kWarning);
  const auto level = now.find(file);
  if (level == now.end() || !level->second.stamp.there || !(known == editor.document.file_stamp()) ||
      level->second.stamp == known)
    return;
  if (level->second.stamp != unsettled_) {  // check again in a second: it may still be being written
    unsettled_ = level->second.stamp;
    return;
  }
  if (!editor.document.dirty()) {
    unsettled_ = {};
    return reload("Read again");
  }
  asking_ = true;
  app_.ask(
      {file.filename().string() + " has changed on disk",
       {"Another program has written it " + time_text(level->second.stamp.time) + ", and there are changes here, too."},
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
