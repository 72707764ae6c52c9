// Units of number fields: SI with prefixes, and some common ones.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace pliant::ui {

// Exponents of metre, kilogram, second, radian, lux, candela.
using Dimension = std::array<int, 6>;
inline constexpr Dimension kNumber{0, 0, 0, 0, 0, 0};
inline constexpr Dimension kAngleOnly{0, 0, 0, 1, 0, 0};
inline constexpr int kAngle = 3;  // its place in a Dimension

struct Unit {
  double si = 1.0;
  Dimension dimension = kNumber;
};

std::optional<Unit> find_unit(std::string_view name);
// "did you mean kPa?" of "KPA"; else "".
std::string spelled(std::string_view name);

}  // namespace pliant::ui
