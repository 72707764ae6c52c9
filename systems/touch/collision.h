// Probe x Deformable -> Contact.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"
#include "systems/touch/touch_state.h"

namespace pliant {

void collision(World& world, Tick tick);

// Nobody's any more.
void drop_contact(SourceState& source, Contact& contact);

// Where a tip's centre is now, and where it was a tick ago. [m] world
dvec3 tip_position(const Probe& probe, const Tip& tip);
dvec3 tip_position_before(const Probe& probe, const Tip& tip);

}  // namespace pliant
