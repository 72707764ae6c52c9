// Between spawn and the first tick: every system's state, sized, in the order in which they need each other.
#pragma once

#include "components/world.h"
#include "runtime/result.h"

namespace pliant {

// Allocates. After it a tick allocates nothing.
Status prepare_world(World& world);

}  // namespace pliant
