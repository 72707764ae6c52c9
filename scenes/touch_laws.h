// Surfaces for tests of the touch tick, and the forces that they must produce. The lists have every law and shape that
// ships (components/built_in.h), so that a test over them covers a new one.
#pragma once

#include <array>
#include <cmath>

#include "components/deformable.h"
#include "components/registered.h"
#include "systems/touch/model/local_model.h"

namespace pliant {

inline Deformable frictionless(SpringLaw law = SpringLaw::kLinear) {
  Deformable d;
  d.spring = law;
  d.friction_static = d.friction_sliding = 0;
  d.reach = 0.03;
  if (!reads_key(law, "table")) return d;
  d.table = {5, {{{0, 0}, {1.2e-3, 0.3}, {2.1e-3, 0.8}, {4.2e-3, 1.0}, {8.1e-3, 5.0}}}};  // toe, rise, plateau, rise
  d.stiffness = d.relaxation_stiffness = stiffness_of(d.table);
  return d;
}

// [N] Normal force at a given depth [m] in equilibrium, written out from level-format.md. A table, or a law
// that is not there: its own, whose arithmetic tests/touch/law_table_test.cpp checks.
inline double law(const Deformable& d, double depth) {
  switch (d.spring) {
    case SpringLaw::kLinear:
    case SpringLaw::kStandardLinearSolid:
      return d.stiffness * depth;
    case SpringLaw::kCubic:
    case SpringLaw::kQuasiLinearCubic:
      return d.stiffness * depth + d.cubic * depth * depth * depth;
    case SpringLaw::kExponential:
    case SpringLaw::kQuasiLinearExponential:
      return d.stiffness / d.stiffening * (std::exp(d.stiffening * depth) - 1);
    case SpringLaw::kTable:
    case SpringLaw::kQuasiLinearTable:
      break;
  }
  return -d.stiffness * restoring_law(d).force(-depth);
}

template <class Enum, std::size_t size>
constexpr std::array<Enum, size> first_values() {
  std::array<Enum, size> all{};
  for (std::size_t i = 0; i < size; ++i) all[i] = static_cast<Enum>(i);
  return all;
}
inline constexpr auto kLaws = first_values<SpringLaw, std::size(kSpringRows)>();
inline constexpr auto kEveryShape = first_values<Shape, std::size(kShapeRows)>();

}  // namespace pliant
