#include "editor/document/recovery.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "content/files/file_io.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kEnding = ".recovery.glb";

// For a copy in the user's folder: the file that describes its origin.
fs::path about_of_copy(const fs::path& copy) {
  return fs::path(copy).concat(".json");
}

// Paths that a copy needs and that have no place in the level's file format.
fs::path scripts_of_copy(const fs::path& copy) {
  return fs::path(copy).concat(".paths.json");
}

Status write_json(const fs::path& file, const Json& json) {
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return write_file(file, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

// Written before the copy, so that a level never lacks its paths.
Status write_scripts(const fs::path& copy, const Scripts& scripts) {
  std::error_code gone;
  if (scripts.empty()) {
    fs::remove(scripts_of_copy(copy), gone);
    return Done{};
  }
  Json all = Json::object();
  for (const auto& [name, script] : scripts) {
    Json keys = Json::array(), rows = Json::array();
    for (const PathKey& k : script->keys)
      keys.push_back({k.time, k.anchor.x, k.anchor.y, k.anchor.z, k.normal.x, k.normal.y, k.normal.z, k.height});
    all[name] = {{"smooth", script->smooth}, {"repeats", script->repeats}, {"keys", std::move(keys)}};
    if (!script->rows) continue;
    const PathTip& t = script->tip;
    for (const PathRow& row : *script->rows)
      rows.push_back({row.time, row.position.x, row.position.y, row.position.z, row.rotation.w, row.rotation.x,
                      row.rotation.y, row.rotation.z});
    all[name]["along"] = script->along;
    all[name]["tip"] = {t.place.x, t.place.y,  t.place.z,  t.radius,   t.axis.x,  t.axis.y,
                        t.axis.z,  t.stands.w, t.stands.x, t.stands.y, t.stands.z};
    all[name]["rows"] = std::move(rows);
  }
  return write_json(scripts_of_copy(copy), all);
}

std::uint64_t fnv1a(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

std::string plain(const std::string& title) {
  std::string name;
  for (const char c : title)
    name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.' ? c : '_';
  return name.substr(0, 60);
}

fs::path whole(const fs::path& file) {
  std::error_code failed;
  const fs::path from_root = fs::absolute(file, failed);
  return failed ? file : from_root.lexically_normal();
}

// For a document with a file: one name per file. Otherwise: a name of this process.
fs::path apart(const fs::path& state_folder, const fs::path& file, const std::string& title) {
  static std::atomic<int> number{0};
  const std::string name =
      file.empty() ? fmt::format("{}-{}-{}", plain(title), ::getpid(), ++number)
                   : fmt::format("{}-{:016x}", plain(file.filename().string()), fnv1a(whole(file).string()));
  return state_folder / (name + kEnding);
}

bool runs(int process) {
  return process > 0 && process != ::getpid() && (::kill(process, 0) == 0 || errno == EPERM);
}

std::string text_of(const Json& json, const char* key) {
  return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : std::string();
}

}  // namespace

fs::path recovery_beside(const fs::path& file) {
  return file.parent_path() / ("." + file.filename().string() + kEnding);
}

std::optional<RecoveryCopy> find_recovery(const fs::path& file, const fs::path& state_folder) {
  std::optional<RecoveryCopy> newest;
  std::error_code gone;
  for (const fs::path& copy : {recovery_beside(file), apart(state_folder, file, "")}) {
    if (!fs::is_regular_file(copy, gone)) continue;
    const auto time = fs::last_write_time(copy, gone);
    if (gone || (newest && newest->time >= time)) continue;
    newest = RecoveryCopy{copy, file, file.parent_path(), file.filename().string(), time};
  }
  return newest;
}

std::vector<RecoveryCopy> find_recoveries(const fs::path& state_folder) {
  std::vector<RecoveryCopy> found;
  std::error_code gone;
  for (const fs::directory_entry& entry : fs::directory_iterator(state_folder, gone)) {
    if (!entry.path().filename().string().ends_with(kEnding)) continue;
    RecoveryCopy copy;
    copy.copy = entry.path();
    copy.time = fs::last_write_time(copy.copy, gone);
    const Result<Bytes> bytes = read_file(about_of_copy(copy.copy));
    const Json about = bytes ? Json::parse(bytes->begin(), bytes->end(), nullptr, false) : Json();
    if (about.is_object()) {
      if (about.contains("process") && about["process"].is_number_integer() && runs(about["process"].get<int>()))
        continue;
      copy.file = text_of(about, "file");
      copy.folder = text_of(about, "folder");
      copy.title = text_of(about, "title");
    }
    if (copy.title.empty()) copy.title = copy.copy.filename().string();
    found.push_back(std::move(copy));
  }
  std::sort(found.begin(), found.end(), [](const RecoveryCopy& a, const RecoveryCopy& b) { return a.time > b.time; });
  return found;
}

Scripts scripts_beside_copy(const fs::path& copy) {
  Scripts scripts;
  const Result<Bytes> bytes = read_file(scripts_of_copy(copy));
  const Json all = bytes ? Json::parse(bytes->begin(), bytes->end(), nullptr, false) : Json();
  if (!all.is_object()) return scripts;
  for (const auto& [name, its] : all.items()) try {
      ScriptKeys script;
      script.smooth = its.at("smooth").get<bool>();
      script.repeats = its.at("repeats").get<bool>();
      for (const Json& k : its.at("keys")) {
        const auto n = k.get<std::array<double, 8>>();
        script.keys.push_back({n[0], {n[1], n[2], n[3]}, {n[4], n[5], n[6]}, n[7]});
      }
      if (its.contains("rows")) {
        script.along = its.at("along").get<bool>();
        const auto t = its.at("tip").get<std::array<double, 11>>();
        script.tip = {{t[0], t[1], t[2]}, t[3], {t[4], t[5], t[6]}, {t[7], t[8], t[9], t[10]}};
        auto rows = std::make_shared<std::vector<PathRow>>();
        for (const Json& row : its.at("rows")) {
          const auto n = row.get<std::array<double, 8>>();
          rows->push_back({n[0], {n[1], n[2], n[3]}, {n[4], n[5], n[6], n[7]}});
        }
        if (!rows->empty()) script.rows = std::move(rows);
      }
      scripts[name] = std::make_shared<const ScriptKeys>(std::move(script));
    } catch (const Json::exception&) {  // invalid content; the others may be valid
    }
  return scripts;
}

void remove_recovery(const RecoveryCopy& copy) {
  std::error_code gone;
  // Temporary files left when the editor crashed during writing.
  const std::string half = copy.copy.filename().string() + ".";
  for (const fs::directory_entry& entry :
       fs::directory_iterator(copy.copy.parent_path().empty() ? "." : copy.copy.parent_path(), gone)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(half) && name.ends_with(".part") && !runs(std::atoi(name.c_str() + half.size())))
      fs::remove(entry.path(), gone);
  }
  fs::remove(copy.copy, gone);
  fs::remove(about_of_copy(copy.copy), gone);
  fs::remove(scripts_of_copy(copy.copy), gone);
}

RecoveryPlace::RecoveryPlace(fs::path file, fs::path folder, std::string title, fs::path state_folder)
    : file_(file.empty() ? file : whole(file)),
      folder_(whole(folder)),
      beside_(file.empty() ? fs::path() : recovery_beside(file_)),
      apart_(apart(state_folder, file, title)),
      state_folder_(std::move(state_folder)),
      title_(std::move(title)) {}

Status RecoveryPlace::write(const State& state, const Scripts& unsaved) {
  Status status = beside_.empty() ? Status(Error{}) : write_scripts(beside_, unsaved);
  if (status) status = save_state(state, beside_);
  if (!status) status = write_apart(state, unsaved);
  written_ = status.ok();
  if (!wanted_) remove();
  return status;
}

Status RecoveryPlace::write_apart(const State& state, const Scripts& unsaved) {
  std::error_code failed;
  fs::create_directories(state_folder_, failed);
  if (Status s = write_scripts(apart_, unsaved); !s) return s;
  if (Status s = save_state(state, apart_); !s) return s;
  const Json about{{"file", file_.string()},
                   {"folder", folder_.string()},
                   {"title", title_},
                   {"process", static_cast<int>(::getpid())}};
  return write_json(about_of_copy(apart_), about);
}

void RecoveryPlace::forget() {
  wanted_ = false;
  remove();
}

void RecoveryPlace::remove() const {
  std::error_code gone;
  for (const fs::path& copy : {beside_, apart_}) {
    if (copy.empty()) continue;
    fs::remove(copy, gone);
    fs::remove(scripts_of_copy(copy), gone);
  }
  fs::remove(about_of_copy(apart_), gone);
}

}  // namespace pliant
