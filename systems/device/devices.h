// Devices in and out of the touch tick. A driver's poses arrive in HapticDevice; only what passed the safety layer
// leaves.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void read_devices(World& world, Tick tick);   // HapticDevice -> Probe pose and velocity
void write_devices(World& world, Tick tick);  // Probe force, tool wrench -> safety -> HapticDevice

// How far what a probe touches has been carried by prescribed motions in this tick, where it touches: the mean over its
// contacts, by their forces. [m] world
dvec3 surface_displacement(const World& world, Entity probe, double dt);

// Somebody else moves this probe or tool from now on: nothing of the hand before is true of the next. Its gate is
// closed, its force begins at zero, and it has given no energy yet. What was counted stays.
void begin_anew(World& world, Entity hand);

// The program's own part of what this probe or tool wants of its device from now on (SafetyState::added). [N], [N m]
// world; a probe's device gets no torque. Does not allocate.
void set_hand_force(World& world, Entity hand, dvec3 force, dvec3 torque);

}  // namespace pliant
