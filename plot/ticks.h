// Where an axis has its numbers.
#pragma once

#include <vector>

namespace pliant {

// Ticks at 1, 2 or 5 times a power of ten: at most `most` intervals over [0, high].
double tick_step(double high, int most);
// The multiples of `step` within [low, high], each larger than the one before: none twice where doubles cannot tell
// them apart, and no more than a plot could show.
std::vector<double> tick_values(double low, double high, double step);
// Whether values from `least` to `most` differ by rounding alone: an axis over them would show nothing.
bool is_flat(double least, double most);

}  // namespace pliant
