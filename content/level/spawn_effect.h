// PLIANT_effect -> Effect, and the path of a guidance.
#pragma once

#include "content/level/spawn_state.h"

namespace pliant {

// After the node's Pose, if it has one.
Status add_effect(SpawnState& state, std::size_t n);

}  // namespace pliant
