// PLIANT_joint -> Joint.
#pragma once

#include "content/level/spawn_state.h"

namespace pliant {

// After every node: finds the bodies that the joints name.
Status add_joints(SpawnState& state);

}  // namespace pliant
