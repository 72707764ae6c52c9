// The user's answers to levels that request more than a kind of device (content/level/device_request.h). An answer
// holds for this file and this exact text only. Stored in $XDG_CONFIG_HOME/pliant/devices.json, else
// ~/.config/pliant/devices.json.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "runtime/result.h"

namespace pliant {

class DeviceAnswers {
 public:
  // Empty `folder`: the user's folder. An unreadable file allows nothing.
  static DeviceAnswers load(const std::filesystem::path& folder = {});
  bool allows(const std::filesystem::path& level, const std::string& id) const;
  // Takes effect in this object even if the file cannot be written, and for a level without a file yet.
  Status allow(const std::filesystem::path& level, const std::string& id);

 private:
  std::filesystem::path file_;
  std::map<std::string, std::set<std::string>> allowed_;  // by level
};

}  // namespace pliant
