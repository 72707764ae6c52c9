// Parameters of surfaces that an animation varies (components/varying.h). At tick n they are those of its time.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void vary_surfaces(World& world, Tick tick);

}  // namespace pliant
