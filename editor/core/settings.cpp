#include "editor/core/settings.h"

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "content/files/file_io.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

fs::path base(const char* variable, const char* below_home) {
  if (const char* set = std::getenv(variable); set && *set) return set;
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / below_home;
  return fs::temp_directory_path();
}

double between(const Json& json, const char* key, double value, double least, double most) {
  if (json.contains(key) && json[key].is_number()) value = std::clamp(json[key].get<double>(), least, most);
  return value;
}

std::map<std::string, std::string> texts(const Json& json, const char* key) {
  std::map<std::string, std::string> out;
  if (json.contains(key) && json[key].is_object())
    for (const auto& [name, value] : json[key].items())
      if (value.is_string()) out[name] = value.get<std::string>();
  return out;
}

}  // namespace

fs::path state_folder() {
  return base("XDG_STATE_HOME", ".local/state") / "pliant";
}

Settings Settings::load(const fs::path& folder, std::string& note) {
  Settings s;
  s.file_ = (folder.empty() ? base("XDG_CONFIG_HOME", ".config") / "pliant" : folder) / "editor.json";
  std::error_code missing;
  if (!fs::exists(s.file_, missing)) return s;
  const Result<Bytes> bytes = read_file(s.file_);
  const Json json = bytes ? Json::parse(bytes->begin(), bytes->end(), nullptr, false) : Json();
  if (!json.is_object()) {
    fs::path aside = s.file_;
    aside += ".unreadable";
    fs::rename(s.file_, aside, missing);
    note = "the settings in " + s.file_.string() + " could not be read; they are kept as " + aside.filename().string() +
           ", and the defaults hold";
    return s;
  }
  if (json.contains("light") && json["light"].is_boolean()) s.light = json["light"];
  if (json.contains("snap") && json["snap"].is_boolean()) s.snap = json["snap"];
  if (json.contains("local_axes") && json["local_axes"].is_boolean()) s.local_axes = json["local_axes"];
  s.scale = between(json, "scale", s.scale, 0.0, 4.0);
  s.autosave = between(json, "autosave", s.autosave, 0.1, 3600.0);
  s.left = between(json, "left", s.left, 120, 2000);
  s.right = between(json, "right", s.right, 160, 2000);
  s.bottom = between(json, "bottom", s.bottom, 60, 2000);
  s.snap_move = between(json, "snap_move", s.snap_move, 1e-6, 1e3);
  s.snap_turn = between(json, "snap_turn", s.snap_turn, 0.1, 180);
  s.snap_scale = between(json, "snap_scale", s.snap_scale, 1e-3, 10);
  if (json.contains("recent") && json["recent"].is_array())
    for (const Json& file : json["recent"])
      if (file.is_string() && s.recent.size() < kMostRecent) s.recent.push_back(file.get<std::string>());
  s.keys = texts(json, "keys");
  if (json.contains("navigation") && json["navigation"].is_string()) s.navigation = json["navigation"];
  if (json.contains("sections") && json["sections"].is_object())
    for (const auto& [name, open] : json["sections"].items())
      if (open.is_boolean()) s.sections[name] = open.get<bool>();
  s.presets = texts(json, "presets");
  return s;
}

Status Settings::save() const {
  std::error_code failed;
  fs::create_directories(file_.parent_path(), failed);
  const Json json{{"light", light},
                  {"scale", scale},
                  {"left", left},
                  {"right", right},
                  {"bottom", bottom},
                  {"recent", recent},
                  {"keys", keys},
                  {"navigation", navigation},
                  {"sections", sections},
                  {"presets", presets},
                  {"snap", snap},
                  {"snap_move", snap_move},
                  {"snap_turn", snap_turn},
                  {"snap_scale", snap_scale},
                  {"local_axes", local_axes},
                  {"autosave", autosave}};
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  return write_file(file_, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

void Settings::used(const fs::path& file) {
  std::error_code ignored;
  const std::string name = fs::absolute(file, ignored).lexically_normal().string();
  std::erase(recent, name);
  recent.insert(recent.begin(), name);
  if (recent.size() > kMostRecent) recent.resize(kMostRecent);
}

}  // namespace pliant
