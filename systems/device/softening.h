// A device has a largest stiffness that it renders stably (DeviceCapabilities::max_stiffness). If the touched object is
// stiffer, the whole force is scaled down by the ratio. Lowering only the slope between two ticks is not enough: at 1
// kHz the ticks' forces themselves follow the stiff surface. A force that rises slowly and falls fast, as with a
// level's max_stiffness (systems/safety), is passive in the tick, but still makes a device with a delay oscillate.
//
// A share of a passive force is passive while the share does not grow. It therefore falls at once, and returns to 1
// only where nothing is touched.
#pragma once

#include "components/world.h"
#include "systems/safety/safety.h"

namespace pliant {

// [N/m] per metre of the world: upper bound of the stiffness that this probe or tool feels. Probe: the laws of its
// contacts along their normals, and effects; bristles are left out, since friction bounds their force. Tool: its coupling.
double felt_stiffness(const World& world, Entity effector);

// Writes state.share for this tick. Before the force goes into the safety layer. Returns
// SafetyLimits::touched [N/m], per metre of the hand.
double soften(const World& world, Entity effector, const HapticDevice& device, SafetyState& state);

// SafetyState of the force of a prepared probe or tool; null for others.
SafetyState* safety_of(World& world, Entity hand);

}  // namespace pliant
