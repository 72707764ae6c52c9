// Probe x Deformable -> Contact.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {

void collision(World& world, Tick tick);

// Ends the contact and frees its source.
void drop_contact(SourceState& source, Contact& contact);

// Centre of a tip now, and a tick ago. [m] world
dvec3 tip_position(const Probe& probe, const Tip& tip);
dvec3 tip_position_before(const Probe& probe, const Tip& tip);

}  // namespace pliant
