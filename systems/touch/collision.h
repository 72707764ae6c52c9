// Probe x Deformable -> Contact.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void collision(World& world, Tick tick);

}  // namespace pliant
