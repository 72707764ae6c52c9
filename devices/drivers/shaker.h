// A force as two shakings, for devices that vibrate and cannot push: how hard something is pressed (slow), and how it
// changes: contact, texture, slip (fast).
#pragma once

#include <algorithm>
#include <cmath>

#include "pliant/math.h"

namespace pliant {

struct Shaking {
  double strong = 0.0, weak = 0.0;  // [1] 0 to 1
};

class Shaker {
 public:
  static constexpr double kFull = 3.0;     // [N] that shakes fully
  static constexpr double kSlow = 0.05;    // [s] what changes slower counts as pressed
  static constexpr double kPressed = 0.5;  // [1] most that pressing alone shakes: a steady touch does not drown texture

  // Without a force there is no shaking at all, at once; a force that is not finite is none.
  Shaking step(const dvec3& force, double dt) {
    const double size = length(force);
    if (!(size > 0.0) || !std::isfinite(size)) {
      slow_ = dvec3(0);
      return {};
    }
    slow_ -= std::expm1(-std::clamp(dt, 0.0, 1.0) / kSlow) * (force - slow_);
    return {kPressed * std::min(length(slow_) / kFull, 1.0), std::min(length(force - slow_) / kFull, 1.0)};
  }

 private:
  dvec3 slow_{0};
};

}  // namespace pliant
