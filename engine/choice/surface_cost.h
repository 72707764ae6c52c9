// Nanoseconds per vertex in the engine's kernels, measured once (bench/results/studies/shapes.csv, bench/results).
// Costs are counted with these constants, so that a choice is the same on every machine.
#pragma once

#include "pliant/parameters.h"

namespace pliant {

inline constexpr double kTickUs = 3.0;     // [us] of a tick, in addition to its vertices
inline constexpr double kMarchNs = 150.0;  // [ns] per vertex whose distance along the surface is computed

// [ns] The volume shape has to sum its coefficient first.
inline double shape_ns(Shape shape) {
  constexpr double kNs[] = {2.6, 3.1, 2.3, 1.0, 2.1, 2.9};
  const auto i = static_cast<std::size_t>(shape);
  return i < std::size(kNs) ? kNs[i] : 20.0;
}

// [ns] Cost of the free surface's motion.
inline double law_ns(SpringLaw law) {
  constexpr double kNs[] = {2.3, 12.5, 39.0, 2.7};
  const auto i = static_cast<std::size_t>(law);
  return i < std::size(kNs) ? kNs[i] : 40.0;
}

}  // namespace pliant
