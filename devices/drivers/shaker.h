// Renders a force by two vibration motors, for devices that cannot push: the pressing force (slow part), and its
// changes from contact, texture and slip (fast part).
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
  static constexpr double kFull = 3.0;     // [N] of full vibration
  static constexpr double kSlow = 0.05;    // [s] slower changes count as pressing
  static constexpr double kPressed = 0.5;  // [1] limit for the pressing part, so that it does not mask texture

  // A zero or non-finite force stops the vibration at once.
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
