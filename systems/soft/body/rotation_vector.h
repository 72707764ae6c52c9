// Rotations and their vectors: axis times angle [rad], the logarithm of a unit quaternion and its inverse. Accurate
// near 0 (no division by a small angle) and near pi (the shorter rotation: lengths in [0, pi]).
#pragma once

#include <cmath>

#include "components/math.h"

namespace pliant {

inline dquat rotation_of(dvec3 vector) {
  const double half = 0.5 * length(vector);
  // sin(half)/half by its series below 1e-4, where the next term is below double precision.
  const double sinc = half < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  return {std::cos(half), 0.5 * sinc * vector.x, 0.5 * sinc * vector.y, 0.5 * sinc * vector.z};
}

inline dvec3 vector_of(dquat rotation) {
  const double sign = rotation.w < 0 ? -1.0 : 1.0;  // q and -q are the same rotation; this one rotates by at most pi
  const dvec3 axis = sign * dvec3(rotation.x, rotation.y, rotation.z);
  const double s = length(axis), c = sign * rotation.w;
  // angle / sin(angle / 2); atan2 is accurate for small s and for small c.
  const double ratio = s < 1e-4 * c ? 2.0 / c * (1.0 - s * s / (3.0 * c * c)) : 2.0 * std::atan2(s, c) / s;
  return ratio * axis;
}

}  // namespace pliant
