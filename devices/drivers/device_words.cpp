#include "devices/drivers/device_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pliant {

std::string DeviceWords::text(const std::string& key, const std::string& otherwise) const {
  for (const auto& [name, value] : words)
    if (name == key) return value;
  return otherwise;
}

Result<DeviceWords> parse_device_words(const std::string& driver, const std::string& text,
                                       std::span<const char* const> keys) {
  DeviceWords parsed;
  const std::size_t mark = text.find('?');
  parsed.id = text.substr(0, mark);
  const std::string where = fmt::format("device `{}:{}`", driver, text);
  for (std::size_t at = mark; at != std::string::npos;) {
    const std::size_t next = text.find('&', at + 1);
    const std::string part = text.substr(at + 1, next == std::string::npos ? next : next - at - 1);
    const std::size_t equals = part.find('=');
    if (equals == std::string::npos)
      return Error{where, fmt::format("`{}` is not KEY=VALUE", part),
                   fmt::format("keys are {}", fmt::join(keys, ", "))};
    const std::string key = part.substr(0, equals);
    if (std::none_of(keys.begin(), keys.end(), [&](const char* known) { return key == known; }))
      return Error{where, fmt::format("unknown key '{}'", key), fmt::format("keys are {}", fmt::join(keys, ", "))};
    if (!parsed.text(key, "").empty()) return Error{where, fmt::format("'{}' is given twice", key), "give it once"};
    parsed.words.emplace_back(key, part.substr(equals + 1));
    at = next;
  }
  return parsed;
}

Result<double> number_of(const std::string& driver, const DeviceWords& words, const std::string& key, double least,
                         double most, double otherwise) {
  const std::string text = words.text(key, "");
  if (text.empty()) return otherwise;
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (*end != '\0' || !(value >= least && value <= most))
    return Error{fmt::format("device `{}:{}`", driver, words.id),
                 fmt::format("{} must be a number from {} to {}; got '{}'", key, least, most, text)};
  return value;
}

Result<std::string> choice_of(const std::string& driver, const DeviceWords& words, const std::string& key,
                              std::span<const char* const> values) {
  const std::string text = words.text(key, values.front());
  if (std::any_of(values.begin(), values.end(), [&](const char* value) { return text == value; })) return text;
  return Error{fmt::format("device `{}:{}`", driver, words.id),
               fmt::format("{} must be one of {}; got '{}'", key, fmt::join(values, ", "), text)};
}

}  // namespace pliant
