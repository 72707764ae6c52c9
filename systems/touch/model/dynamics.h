// Awake zones -> stream.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void dynamics(World& world, Tick tick);

}  // namespace pliant
