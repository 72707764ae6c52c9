// Jumps of a tool's force where a new model arrives.
#pragma once

#include <cstddef>
#include <vector>

#include "lab/study/linearisation/study_linearisation.h"

namespace pliant {

// Force changes in the ticks of each update, relative to the largest change in the other ticks of the two steps around
// it. `event`: per tick, a change of a felt contact in it or in the previous tick.
void find_jumps(const std::vector<Vector6>& wrench, const std::vector<bool>& event, std::size_t length,
                LinearisationFigures& out);

}  // namespace pliant
