// Nanoseconds a vertex in the kernels that ship, measured once (bench/results/studies/shapes.csv, bench/results):
// counted with, so that a choice is the same on every machine.
#pragma once

#include "pliant/parameters.h"

namespace pliant {

inline constexpr double kTickUs = 3.0;     // [us] of a tick beside its vertices
inline constexpr double kMarchNs = 150.0;  // [ns] a vertex whose distance along the surface is found

// [ns] The volume shape sums its coefficient first.
inline double shape_ns(Shape shape) {
  constexpr double kNs[] = {2.6, 3.1, 2.3, 1.0, 2.1, 2.9};
  const auto i = static_cast<std::size_t>(shape);
  return i < std::size(kNs) ? kNs[i] : 20.0;
}

// [ns] What the free surface's own motion takes.
inline double law_ns(SpringLaw law) {
  constexpr double kNs[] = {2.3, 12.5, 39.0, 2.7};
  const auto i = static_cast<std::size_t>(law);
  return i < std::size(kNs) ? kNs[i] : 40.0;
}

}  // namespace pliant
