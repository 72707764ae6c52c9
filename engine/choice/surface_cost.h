// Nanoseconds per vertex in the engine's kernels, measured once (bench/results/studies/shapes.csv, bench/results).
// Costs are counted with these constants, so that a choice is the same on every machine.
#pragma once

#include "components/registered.h"

namespace pliant {

inline constexpr double kTickUs = 3.0;  // [us] of a tick, in addition to its vertices
inline constexpr double kSurfaceNs =
    2.0;  // [ns] more per vertex: its distance along the surface (an arc, or a kept chart)

// [ns] The volume shape has to sum its coefficient first.
inline double shape_ns(Shape shape) {
  return row_of(shape).ns;
}

}  // namespace pliant
