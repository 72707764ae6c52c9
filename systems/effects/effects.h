// Effects in space on every probe: Effect x Probe -> force, beside those of its contacts.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

// After friction_feedback, which begins the force anew.
void effects(World& world, Tick tick);

// Makes the run state of all effects and probes; what is there already is kept. After prepare_touch. Allocates.
Status prepare_effects(World& world);

}  // namespace pliant
