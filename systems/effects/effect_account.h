// The energy of a probe's effects, between the potentials and the safety layer.
//
// A potential gives back what the hand has put in, and what it held where the hand came to it: a probe may begin above
// a magnet. The passivity observer would take the second for energy that is made, and withhold it. So the force of the
// potentials is beside the observer, as a tool's weight is: it fades in once the gate is open, and its work is not
// counted there. It has an account of its own, the reserve T, in the potentials' U >= 0:
//
//   T += s (U - U before) + (rise of the gate's share) U,   0 <= T <= U,
//
// where s is the mean share of the force that was sent. While all of it is sent T = U. A limit that rises and missed
// ticks send less on the way up than on the way down: T is spent before U, and the rest of the force goes to the
// observer like any other force. So the hand gets at most what it gave and what the potentials held where they let it
// in. The work of a torque that the device does not render is left out: no hand gave it. The work of a moving effect is
// the motion's. Drag is always the observer's.
#pragma once

#include "components/world.h"
#include "systems/safety/safety.h"

namespace pliant {

// Part of the probe's wanted wrench that is beside the observer: of what is sent at the share `share`.
struct BesideObserver {
  dvec3 force{0}, torque{0};  // [N], [N m] world
};
BesideObserver effects_beside(const World& world, Entity probe, double share);
// After make_safe with that part as SafetyLimits::weight. `unfelt` [rad]: the probe's turn in this tick, if its device
// renders no torque.
void keep_account(World& world, Entity probe, const SafetyState& safety, double share, dvec3 unfelt);

}  // namespace pliant
