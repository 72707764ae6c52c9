// Contacts -> amplitudes and reached zones.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void force_field(World& world, Tick tick);

}  // namespace pliant
