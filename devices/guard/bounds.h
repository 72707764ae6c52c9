// Validity and bounds of what a device senses and renders.
#pragma once

#include <algorithm>
#include <cmath>

#include "pliant/driver.h"

namespace pliant {

inline bool finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool finite(const DeviceWrench& wrench) {
  return finite(wrench.force) && finite(wrench.torque) && std::isfinite(wrench.grip);
}

// Clamps the norm, not each axis, so that the direction is kept.
inline dvec3 clamp_norm(dvec3 v, double most) {
  const double size = length(v);
  return size > most ? v * (most / size) : v;
}

// 0: unspecified. A parameter can only lower a limit.
inline double lowest(double device, double other) {
  return device > 0.0 && other > 0.0 ? std::min(device, other) : std::max(device, other);
}

}  // namespace pliant
