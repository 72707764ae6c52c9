// The energy that several hands store in one object. Each hand's account (systems/safety) holds what it has given.
// Where one hand leaves and another bears the load from then on, the other is pushed out with energy that the first
// gave: it goes from account to account, so that all hands together never get more than they gave. Without it the other
// hand's force would be withheld.
//
// A hand gets no more than what its contacts store now, and another gives no more than it has given to that object and
// does not need for its own contacts. A guard at a device (devices/guard) knows its own hand alone, and stays passive
// for it.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

struct ProbeState;

// Joules of a hand per joule of the world, where its device renders a share or has a scaled workspace.
double joules_of(const World& world, const ProbeState& hand);

// Before the forces of this tick go into the safety layer.
void share_accounts(World& world, Tick tick);

}  // namespace pliant
