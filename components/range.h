// Bounds of a number. Ranges that content and systems both read are in the component's header; all others are in the
// table of keys (content/keys/extension_table.cpp).
#pragma once

#include <limits>

namespace pliant {

struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;                     // min itself is excluded
  constexpr bool holds(double value) const {  // false for NaN
    return (above_min ? value > min : value >= min) && value <= max;
  }
};

inline constexpr Range kFrictionRange{0.0, 10.0};  // [1] of every coefficient of friction

}  // namespace pliant
