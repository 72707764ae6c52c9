// Length of a run, and notes about longer scripts, motions and recordings that it cuts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "components/world.h"
#include "engine/run/recording.h"
#include "engine/run/simulated_hands.h"

namespace pliant {

struct RunLength {
  std::uint64_t ticks = 0;
  std::vector<std::string> notes;  // what is cut, with the remedy
};

// `seconds`: of --seconds. 0: to the end of the longest device script or non-repeating motion, at most an hour; 4 s
// without either. `replay` may be null; a replay runs to its end. `windowed`: until the window is closed.
RunLength run_length(double seconds, bool windowed, const World& world, const SimulatedHands& simulated,
                     const Recording* replay);

}  // namespace pliant
