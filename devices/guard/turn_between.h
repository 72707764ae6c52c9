// The rotation between two rotations.
#pragma once

#include <cmath>

#include "pliant/math.h"

namespace pliant {

// The shortest rotation vector [rad], in world axes, from `from` to `to`.
inline dvec3 turn_between(dquat from, dquat to) {
  dquat turn = to * glm::conjugate(from);
  if (turn.w < 0.0) turn = -turn;
  const dvec3 axis(turn.x, turn.y, turn.z);
  const double sine = length(axis);
  return sine > 1e-12 ? axis * (2.0 * std::atan2(sine, turn.w) / sine) : 2.0 * axis;
}

}  // namespace pliant
