// A list of words in one string.
#pragma once

#include <cstddef>
#include <string_view>

namespace pliant {

// Whether `words`, separated by single spaces, have this one.
constexpr bool has_word(std::string_view words, std::string_view word) {
  while (!words.empty()) {
    const std::size_t end = words.find(' ');
    if (words.substr(0, end) == word) return true;
    words = end == std::string_view::npos ? "" : words.substr(end + 1);
  }
  return false;
}

}  // namespace pliant
