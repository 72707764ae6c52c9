// What a user has answered to levels that ask for more than a kind of device (content/level/device_request.h): for this
// file and this very text only. $XDG_CONFIG_HOME/pliant/devices.json, else ~/.config/pliant/devices.json.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "runtime/result.h"

namespace pliant {

class DeviceAnswers {
 public:
  // `folder` empty: the user's. A file that cannot be read allows nothing.
  static DeviceAnswers load(const std::filesystem::path& folder = {});
  bool allows(const std::filesystem::path& level, const std::string& id) const;
  // Holds for this object even where it cannot be written, and for a level that has no file yet.
  Status allow(const std::filesystem::path& level, const std::string& id);

 private:
  std::filesystem::path file_;
  std::map<std::string, std::set<std::string>> allowed_;  // by level
};

}  // namespace pliant
