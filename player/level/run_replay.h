// The recording of a run that is a replay.
#pragma once

#include "player/level/run_setup.h"

namespace pliant {

// Reads it into the run, and says what is not repeated.
Outcome load_replay(const RunOptions& options, Prepared& run);
// Says whether the level differs from the recorded one; sets run.scene.
void compare_scene(const RunOptions& options, const Level& level, Prepared& run);
// Applies its driver settings, and checks that it fits the run's world.
Outcome apply_replay(const RunOptions& options, Prepared& run);

}  // namespace pliant
