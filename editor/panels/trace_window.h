// The stretch of a played run that the plots show.
#pragma once

#include <cstddef>
#include <utility>

#include "editor/play/play.h"

namespace pliant {

inline constexpr double kPlotSeconds = 10.0;  // [s] of the plots
inline constexpr double kLeastForce = 0.5;    // [N] of an axis
inline constexpr double kLeastDepth = 2e-3;   // [m]

// The samples between two times, as indices into the deque.
std::pair<std::size_t, std::size_t> samples_between(const PlayTrace& trace, double low, double high);
// [s] Where the plots end: at the newest sample, or around the moment that was gone back to.
double window_end(const Play& play);

}  // namespace pliant
