// Surfaces for tests of the touch tick, and the forces that they must produce.
#pragma once

#include <cmath>

#include "components/deformable.h"
#include "runtime/assert.h"

namespace pliant {

inline Deformable frictionless(SpringLaw law = SpringLaw::kLinear) {
  Deformable d;
  d.spring = law;
  d.friction_static = d.friction_sliding = 0;
  d.reach = 0.03;
  return d;
}

// [N] Normal force at a given depth [m] in equilibrium, written out from level-format.md.
inline double law(const Deformable& d, double depth) {
  switch (d.spring) {
    case SpringLaw::kLinear:
    case SpringLaw::kStandardLinearSolid:
      return d.stiffness * depth;
    case SpringLaw::kCubic:
      return d.stiffness * depth + d.cubic * depth * depth * depth;
    case SpringLaw::kExponential:
      return d.stiffness / d.stiffening * (std::exp(d.stiffening * depth) - 1);
  }
  UNREACHABLE();
}

inline constexpr SpringLaw kLaws[] = {SpringLaw::kLinear, SpringLaw::kCubic, SpringLaw::kExponential,
                                      SpringLaw::kStandardLinearSolid};

}  // namespace pliant
