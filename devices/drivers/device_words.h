// Parses the text after "NAME:" of a device: `ID?KEY=VALUE&KEY=VALUE`, each part optional.
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

// Error: a part without '=', a key not in `keys`, or a duplicate key.
Result<DeviceWords> parse_device_words(const std::string& driver, const std::string& text,
                                       std::span<const char* const> keys);
// A number within [least, most]; `otherwise` if the key is absent.
Result<double> number_of(const std::string& driver, const DeviceWords& words, const std::string& key, double least,
                         double most, double otherwise);
// One of `values`; the first if the key is absent.
Result<std::string> choice_of(const std::string& driver, const DeviceWords& words, const std::string& key,
                              std::span<const char* const> values);

}  // namespace pliant
