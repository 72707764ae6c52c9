#include "editor/ui/script_words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

namespace pliant::ui {
namespace {

bool is_manner(const std::string& word) {
  constexpr const char* kWords[] = {"right", "middle", "double", "shift", "control", "alt", "in", "to"};
  return std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords);
}

}  // namespace

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

Manner manner_of(const std::vector<std::string>& words) {
  Manner m;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "right") m.button = MouseButton::kRight;
    if (words[i] == "middle") m.button = MouseButton::kMiddle;
    if (words[i] == "double") m.twice = true;
    if (words[i] == "shift") m.modifiers |= kShift;
    if (words[i] == "control") m.modifiers |= kControl;
    if (words[i] == "alt") m.modifiers |= kAlt;
    if (words[i] == "in" && i + 1 < words.size()) m.seconds = number_of(words[i + 1]).value_or(m.seconds);
  }
  return m;
}

std::string leading_address(const std::vector<std::string>& words, std::size_t& i) {
  std::string address;
  for (; i < words.size() && !is_manner(words[i]); ++i) address += (address.empty() ? "" : " ") + words[i];
  return address;
}

}  // namespace pliant::ui
