#include "devices/spec.h"

#include <charconv>
#include <cmath>
#include <utility>

namespace pliant {

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  return begin == std::string_view::npos ? std::string_view{}
                                         : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

namespace {

// Longer units first, so that "ms" is not read as "s".
std::optional<double> with_unit(std::string_view text,
                                std::initializer_list<std::pair<std::string_view, double>> units) {
  for (const auto& [unit, factor] : units) {
    if (!text.ends_with(unit)) continue;
    const std::optional<double> number = plain_number(text.substr(0, text.size() - unit.size()));
    if (number) return *number * factor;
    return std::nullopt;
  }
  return plain_number(text);
}

}  // namespace

std::vector<std::string> split(std::string_view text, char mark) {
  std::vector<std::string> parts;
  if (trimmed(text).empty()) return parts;
  for (;;) {
    const std::size_t end = text.find(mark);
    parts.emplace_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

Option option_of(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return {"", std::string(trimmed(text))};
  return {std::string(trimmed(text.substr(0, equals))), std::string(trimmed(text.substr(equals + 1)))};
}

std::optional<double> plain_number(std::string_view text) {
  text = trimmed(text);
  double value = 0.0;
  const std::from_chars_result read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc{} || read.ptr != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<double> seconds_of(std::string_view text) {
  return with_unit(text, {{"ms", 1e-3}, {"us", 1e-6}, {"s", 1.0}});
}
std::optional<double> metres_of(std::string_view text) {
  return with_unit(text, {{"mm", 1e-3}, {"um", 1e-6}, {"m", 1.0}});
}
std::optional<double> newtons_of(std::string_view text) {
  return with_unit(text, {{"mN", 1e-3}, {"N", 1.0}});
}
std::optional<double> share_of(std::string_view text) {
  const std::optional<double> share = with_unit(text, {{"%", 0.01}});
  return share && *share >= 0.0 && *share <= 1.0 ? share : std::nullopt;
}

std::optional<dvec3> vector_of(std::string_view text) {
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() != 3) return std::nullopt;
  dvec3 v(0);
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> number = plain_number(parts[static_cast<std::size_t>(i)]);
    if (!number) return std::nullopt;
    v[i] = *number;
  }
  return v;
}

}  // namespace pliant
