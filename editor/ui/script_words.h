// Words of a script's steps: numbers, places, and the manner of a press.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "viewer/window/window_input.h"

namespace pliant::ui {

// [s] Limit for `await`, and for the editor to become idle.
inline constexpr double kScriptPatience = 60.0;

// Words after a place: a button, modifiers.
struct Manner {
  MouseButton button = MouseButton::kLeft;
  std::uint8_t modifiers = 0;
  bool twice = false;
  double seconds = 0.2;
};

// Finite; empty: not a number.
std::optional<double> number_of(const std::string& text);
Manner manner_of(const std::vector<std::string>& words);
// Addresses may contain blanks: everything up to a modifier word.
std::string leading_address(const std::vector<std::string>& words, std::size_t& i);

}  // namespace pliant::ui
