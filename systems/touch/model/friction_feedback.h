// Contacts -> Probe force.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void friction_feedback(World& world, Tick tick);

}  // namespace pliant
