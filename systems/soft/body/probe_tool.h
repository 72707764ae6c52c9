// A probe among soft and rigid bodies: its shell as a light rigid tool, held on the device by the probe's own coupling.
// The same contacts, soft step and 1 kHz tick as for any instrument. Yielding surfaces and other probes it passes: the
// ones press a probe by their own law where its device is, and probes do not meet each other.
#pragma once

#include "components/soft_body.h"
#include "components/world.h"
#include "systems/soft/body/rigid_state.h"

namespace pliant {

// Tunables. Unit, usual value, and what changing it does.
inline constexpr double kProbeMass = 0.02;  // [kg] lighter follows the hand better; heavier is steadier on its spring
inline constexpr double kProbeInertia = 2e-5;      // [kg m2] of a stylus of that mass and 0.1 m: a tip does not roll
inline constexpr double kProbeTurn = 1.0;          // [N m/rad] holds its rotation to the device's
inline constexpr double kProbeTurnDamping = 6e-3;  // [N m s/rad]
inline constexpr double kProbeMaxTorque = 10.0;    // [N m]
inline constexpr double kProbeHeadroom = 4.0;      // [1] of the device's largest force, where the coupling saturates

// Those that meet bodies in this world, in the registry's order.
std::vector<Entity> probe_tools(const World& world);
Handle6 probe_handle(const Probe& probe, const HapticDevice& device);
RigidMass probe_mass();

}  // namespace pliant
