// Positions of the ticks of an axis.
#pragma once

#include <vector>

namespace pliant {

// Tick distance of 1, 2 or 5 times a power of ten: at most `most` intervals over [0, high].
double tick_step(double high, int most);
// The multiples of `step` within [low, high], strictly increasing even if doubles cannot distinguish neighbours, and no
// more than a plot could show.
std::vector<double> tick_values(double low, double high, double step);
// True if the range from `least` to `most` is due to rounding alone: its axis would show nothing.
bool is_flat(double least, double most);

}  // namespace pliant
