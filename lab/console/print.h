// Output to stdout. Strings from files, arguments and devices are made printable before they are formatted
// (runtime/printable.h).
#pragma once

#include <fmt/format.h>

#include <concepts>
#include <cstdio>
#include <string>
#include <string_view>

#include "runtime/printable.h"

namespace pliant {

template <class T>
concept IsText = std::convertible_to<const T&, std::string_view>;

inline std::string shown(const IsText auto& text) {
  return printable(text);
}
template <class T>
requires(!IsText<T>) const T& shown(const T& value) {
  return value;
}

// Prints to stdout; never throws. The format may contain line ends; the arguments may not.
template <class... Args>
void print(fmt::format_string<decltype(shown(std::declval<const Args&>()))...> format, const Args&... args) {
  const std::string text = fmt::format(format, shown(args)...);
  std::fwrite(text.data(), 1, text.size(), stdout);
}

// Prints ASCII JSON. Control characters are escaped; invalid UTF-8 is replaced.
template <class Json>
void print_json(const Json& json) {
  const std::string text = json.dump(2, ' ', /*ensure_ascii*/ true, Json::error_handler_t::replace) + '\n';
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace pliant
