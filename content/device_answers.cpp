#include "content/device_answers.h"

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "content/files/file_io.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using AnswersJson = nlohmann::json;

fs::path user_folder() {
  if (const char* set = std::getenv("XDG_CONFIG_HOME"); set && *set) return fs::path(set) / "pliant";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".config/pliant";
  return {};
}

// One key per file, however the path is written. JSON needs UTF-8: other bytes of a path are escaped.
std::string key_of_level(const fs::path& level) {
  std::error_code failed;
  const fs::path whole = level.empty() ? level : fs::weakly_canonical(level, failed);
  return printable((failed ? level : whole).string());
}

}  // namespace

DeviceAnswers DeviceAnswers::load(const fs::path& folder) {
  DeviceAnswers answers;
  const fs::path in = folder.empty() ? user_folder() : folder;
  if (in.empty()) return answers;
  answers.file_ = in / "devices.json";
  std::error_code missing;
  if (!fs::exists(answers.file_, missing)) return answers;
  const Result<Bytes> bytes = read_file(answers.file_);
  const AnswersJson json = bytes ? AnswersJson::parse(bytes->begin(), bytes->end(), nullptr, false) : AnswersJson();
  if (!json.is_object()) return answers;
  for (const auto& [level, ids] : json.items())
    if (ids.is_array())
      for (const AnswersJson& id : ids)
        if (id.is_string()) answers.allowed_[level].insert(id.get<std::string>());
  return answers;
}

bool DeviceAnswers::allows(const fs::path& level, const std::string& id) const {
  const auto found = allowed_.find(key_of_level(level));
  return found != allowed_.end() && found->second.contains(printable(id));
}

Status DeviceAnswers::allow(const fs::path& level, const std::string& id) {
  allowed_[key_of_level(level)].insert(printable(id));
  if (file_.empty() || level.empty()) return Done{};
  std::error_code failed;
  fs::create_directories(file_.parent_path(), failed);
  AnswersJson json = AnswersJson::object();
  for (const auto& [of, ids] : allowed_)
    if (!of.empty()) json[of] = ids;
  const std::string text = json.dump(2) + "\n";
  return write_file(file_, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace pliant
