// Devices in and out of the touch tick. A driver's poses arrive in HapticDevice; only forces that passed the safety
// layer leave.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void read_devices(World& world, Tick tick);   // HapticDevice -> Probe pose and velocity
void write_devices(World& world, Tick tick);  // Probe force, tool wrench -> safety -> HapticDevice

// Displacement of the touched surfaces by prescribed motions in this tick, at the contacts, and of viscous regions: mean
// over those of the probe, weighted by force. [m] world
dvec3 surface_displacement(const World& world, Entity probe, double dt);

// Called when control of this probe or tool passes to another source; no earlier state of the hand is valid. Its gate
// closes, its force starts at zero, and its returned energy is reset. Counters are kept.
void begin_anew(World& world, Entity hand);

// Sets the program's additional wrench for this probe or tool from now on (SafetyState::added). [N], [N m] world; a
// probe's device gets no torque. Does not allocate.
void set_hand_force(World& world, Entity hand, dvec3 force, dvec3 torque);

}  // namespace pliant
