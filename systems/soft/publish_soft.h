// Bodies, contacts and handles -> SoftSnapshot for the visual clock; presses -> touch clock.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void publish_soft(World& world, Tick tick);

}  // namespace pliant
