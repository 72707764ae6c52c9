// Dirty zones -> Snapshot.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void publish(World& world, Tick tick);

}  // namespace pliant
