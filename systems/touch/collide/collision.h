// Probe x Deformable -> Contact.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {

void collision(World& world, Tick tick);

// Ends the contact and frees its source.
void drop_contact(SourceState& source, Contact& contact);

// Place of a tip now, and a tick ago. World frame.
TipPlace tip_place(const Probe& probe, const Tip& tip);
TipPlace tip_place_before(const Probe& probe, const Tip& tip);

}  // namespace pliant
