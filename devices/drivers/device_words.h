// What stands behind "NAME:" where a device is named: `ID?KEY=VALUE&KEY=VALUE`, each part optional.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/result.h"

namespace pliant {

struct DeviceWords {
  std::string id;
  std::vector<std::pair<std::string, std::string>> words;

  // The value of `key`, or `otherwise`.
  std::string text(const std::string& key, const std::string& otherwise) const;
};

// Fails on a part without '=', on a key that is not among `keys`, and on one that comes twice.
Result<DeviceWords> parse_device_words(const std::string& driver, const std::string& text,
                                       std::span<const char* const> keys);
// A number within [least, most]; `otherwise` where the key is not given.
Result<double> number_of(const std::string& driver, const DeviceWords& words, const std::string& key, double least,
                         double most, double otherwise);
// One of `values`; the first where the key is not given.
Result<std::string> choice_of(const std::string& driver, const DeviceWords& words, const std::string& key,
                              std::span<const char* const> values);

}  // namespace pliant
