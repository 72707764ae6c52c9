// Between load and the first soft step: a Body for everything that contacts can push or press.
#pragma once

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// Call after prepare_touch and prepare_tools. Makes World::soft and World::soft_snapshots anew from SoftBody, RigidBody
// and Deformable; where nothing soft or rigid could move they are null, and there is no soft clock. Refuses bodies that
// weigh nothing, and a soft_step that is no duration. Allocates.
Status prepare_soft(World& world);

}  // namespace pliant
