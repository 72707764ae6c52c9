#include "editor/document/document.h"

#include "content/gltf/form/gltf_document.h"
#include "content/level/unit.h"
#include "content/level_file.h"
#include "editor/document/recovery.h"

namespace pliant {

namespace fs = std::filesystem;

Document::Document() : Document(State(), 1) {}

Document::Document(State state, NodeId next) : next_id_(next) {
  if (!state.rest) state.rest = std::make_shared<const Level>();
  steps_.push_back({"", std::move(state), 0});
}

Result<Document> Document::open(const fs::path& file, double unit) {
  const FileStamp stamp = stamp_of(file);  // changes during reading are noticed later
  Result<Level> level = load_level(file);
  if (!level) return level.error();
  const bool is_level = level->source && level->has_pliant();
  if (unit != 1.0) scale_roots(*level, unit);
  std::vector<std::string> notes = level->notes;
  NodeId next = 1;
  State state = state_of(std::move(*level), next);
  Document document(std::move(state), next);
  document.notes_ = std::move(notes);
  document.folder_ = file.parent_path();
  document.read_scripts(document.steps_[0].state);
  if (is_level) {
    document.file_ = file;
    document.stamp_ = stamp;
  } else {
    document.saved_ = ~std::uint64_t{0};  // the content is in no file yet
  }
  return document;
}

Result<Document> Document::recover(const fs::path& copy, const fs::path& file, const fs::path& folder) {
  Result<Document> document = open(copy);
  if (!document) return document;
  document->file_ = file;
  document->folder_ = !file.empty() ? file.parent_path() : folder.empty() ? copy.parent_path() : folder;
  document->saved_ = ~std::uint64_t{0};
  document->recovered_ = true;
  State& state = document->steps_[0].state;
  state.scripts.clear();
  document->read_scripts(state);  // from the document's own folder
  for (auto& [name, keys] : scripts_beside_copy(copy)) state.scripts[name] = keys;
  document->remember_file();
  return document;
}

Status Document::change(const std::string& what, Result<State> next, const std::string& gesture) {
  if (!next) return next.error();
  if (same(state(), *next)) return Done{};
  const bool goes_on = !gesture.empty() && gesture == gesture_ && now_ > 0 && now_ + 1 == steps_.size();
  gesture_ = gesture;
  if (goes_on) {
    steps_[now_].state = std::move(*next);
    steps_[now_].revision = next_revision_++;
    return Done{};
  }
  steps_.resize(now_ + 1);
  steps_.push_back({what, std::move(*next), next_revision_++});
  ++now_;
  return Done{};
}

bool Document::drop_gesture(const std::string& gesture) {
  if (gesture.empty() || gesture != gesture_ || now_ == 0 || now_ + 1 != steps_.size()) return false;
  gesture_.clear();
  steps_.pop_back();
  --now_;
  return true;
}

void Document::undo() {
  gesture_.clear();
  if (can_undo()) --now_;
}

void Document::redo() {
  gesture_.clear();
  if (can_redo()) ++now_;
}

void Document::go_to_step(std::size_t i) {
  gesture_.clear();
  if (i < steps_.size()) now_ = i;
}

std::string Document::title() const {
  if (!file_.empty()) return file_.filename().string();
  return state().rest->name.empty() ? "untitled" : state().rest->name + " (not saved)";
}

// Writes all or nothing, scripts first, so that a level never lacks a script that it refers to. A level that could not
// be opened again is an error before anything is replaced.
Status Document::write(const fs::path& file, const State& state, bool scripts_too) const {
  std::vector<MadeFile> files;
  if (scripts_too)
    for (const auto& [name, keys] : state.scripts) {
      const auto before = scripts_on_disk_.find(name);
      const bool here = file.parent_path() == folder_;
      if (here && before != scripts_on_disk_.end() && before->second == keys) continue;
      const Result<std::string> text = text_of_keys(*keys, name);
      if (!text) return text.error();
      files.push_back({file.parent_path() / name, Bytes(text->begin(), text->end())});
    }
  Level whole = level_of(state);
  if (!whole.source) drop_unseen_meshes(whole);
  Result<std::vector<MadeFile>> level = make_level_files(whole, file);
  if (!level) return level.error();
  for (MadeFile& each : *level) files.push_back(std::move(each));
  return write_made(files);
}

void Document::read_scripts(State& state) {
  for (const auto& each : state.nodes) {
    const std::optional<HapticDevice>& device = each->node.device;
    if (!device || device->driver != DriverKind::kScript || state.scripts.contains(device->file)) continue;
    if (device->file.find('/') != std::string::npos || device->file.find('%') != std::string::npos) continue;
    if (Result<ScriptKeys> keys = load_keys(folder_ / device->file))
      state.scripts[device->file] = std::make_shared<const ScriptKeys>(*std::move(keys));
  }
  scripts_on_disk_ = state.scripts;
}

Scripts Document::unsaved_scripts() const {
  Scripts all;
  for (const auto& [name, keys] : state().scripts)
    if (const auto saved = scripts_on_disk_.find(name); saved == scripts_on_disk_.end() || saved->second != keys)
      all[name] = keys;
  return all;
}

Status Document::save() {
  if (file_.empty()) return Error{"save", "the level has no file yet", "use Save as"};
  return save_as(file_);
}

Status Document::save_as(const fs::path& file) {
  if (Status s = write(file, state(), true); !s) return s;
  scripts_on_disk_ = state().scripts;
  file_ = file;
  folder_ = file.parent_path();
  saved_ = revision();
  remember_file();
  return Done{};
}

Status Document::save_copy(const fs::path& file) const {
  return write(file, state(), file.parent_path() != folder_);
}

Status Document::revert() {
  if (file_.empty()) return Error{"revert", "the level has no file yet", "undo instead"};
  const FileStamp stamp = stamp_of(file_);
  Result<Level> level = load_level(file_);
  if (!level) return level.error();
  revert_to(std::move(*level), stamp);
  return Done{};
}

void Document::revert_to(Level level, const FileStamp& stamp, const std::string& what) {
  notes_ = level.notes;
  State state = state_of(std::move(level), next_id_);
  read_scripts(state);
  gesture_.clear();
  steps_.resize(now_ + 1);
  steps_.push_back({what, std::move(state), next_revision_++});
  ++now_;
  saved_ = revision();
  stamp_ = stamp;
}

void Document::remember_file() {
  stamp_ = stamp_of(file_);
}

bool Document::file_changed() const {
  if (file_.empty()) return false;
  const FileStamp now = stamp_of(file_);
  return now.there && now != stamp_;  // deleted: the document is unaffected
}

void Document::accept_file() {
  remember_file();
  saved_ = ~std::uint64_t{0};
}

void Document::in_every_state(const std::function<bool(State&)>& change) {
  for (Step& step : steps_) {
    if (!change(step.state)) continue;
    const bool is_saved = step.revision == saved_;
    step.revision = next_revision_++;
    if (is_saved) saved_ = step.revision;
  }
}

bool Document::is_on_disk(const std::string& name, const ScriptKeys& keys) const {
  const auto known = scripts_on_disk_.find(name);
  return known != scripts_on_disk_.end() && *known->second == keys;
}

bool Document::script_read_again(const std::string& name, const ScriptKeys& keys) {
  const auto fresh = std::make_shared<const ScriptKeys>(keys);
  const auto known = scripts_on_disk_.find(name);
  const std::shared_ptr<const ScriptKeys> before = known == scripts_on_disk_.end() ? nullptr : known->second;
  scripts_on_disk_[name] = fresh;
  in_every_state([&](State& state) {
    const auto has = state.scripts.find(name);
    if (has != state.scripts.end() && (!before || !(*has->second == *before))) return false;
    state.scripts[name] = fresh;
    return true;
  });
  return *state().scripts.at(name) == keys;  // in_every_state ensures that there is one
}

void Document::picture_read_again(const std::string& uri, const Image& image,
                                  const std::vector<std::uint8_t>& encoded) {
  std::map<const Level*, std::shared_ptr<const Level>> anew;  // states share it
  in_every_state([&](State& state) {
    const Level* const before = state.rest.get();
    if (!before->source || !before->source->json.contains("images")) return false;
    if (!anew.contains(before)) {
      const Json& images = before->source->json["images"];
      auto rest = std::make_shared<Level>(*before);
      auto source = std::make_shared<SourceDocument>(*before->source);
      bool found = false;
      for (std::size_t i = 0; i < images.size() && i < rest->images.size(); ++i) {
        if (!images[i].contains("uri") || images[i]["uri"] != uri) continue;
        if (i < source->images.size() && source->images[i] == encoded) continue;  // for instance, saved by this editor
        const std::string name = rest->images[i].name;
        rest->images[i] = image;
        rest->images[i].name = name;
        if (i < source->images.size()) source->images[i] = encoded;
        found = true;
      }
      rest->source = std::move(source);
      anew[before] = found ? std::move(rest) : nullptr;
    }
    if (!anew[before]) return false;
    state.rest = anew[before];
    return true;
  });
}

}  // namespace pliant
