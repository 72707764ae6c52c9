// How long a run takes, and what it leaves of scripts, motions and recordings that are longer.
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
  std::vector<std::string> notes;  // what is cut, with the cure
};

// `seconds`: of --seconds; 0: to the end of the longest script of a device and of the longest motion that does not
// repeat, an hour at most; 4 s where there is neither. `replay` may be null; it runs to its end. `windowed`: until the
// window is closed.
RunLength run_length(double seconds, bool windowed, const World& world, const SimulatedHands& simulated,
                     const Recording* replay);

}  // namespace pliant
