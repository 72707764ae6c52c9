// A probe among soft and rigid bodies: its shell is a light rigid tool, coupled to the device by the probe's coupling.
// It uses the same contacts, soft step and 1 kHz tick as any instrument. It does not collide with yielding surfaces,
// which press the probe by their law at its device, nor with other probes.
#pragma once

#include "components/soft_body.h"
#include "components/world.h"
#include "systems/soft/body/rigid_state.h"

namespace pliant {

// Tunables. Unit, usual value, and what changing it does.
inline constexpr double kProbeMass = 0.02;     // [kg] lighter: follows the hand better; heavier: steadier on its spring
inline constexpr double kProbeInertia = 2e-5;  // [kg m2] of a stylus of that mass and 0.1 m: a tip does not roll
inline constexpr double kProbeTurn = 1.0;      // [N m/rad] couples its rotation to the device's
inline constexpr double kProbeTurnDamping = 6e-3;  // [N m s/rad]
inline constexpr double kProbeMaxTorque = 10.0;    // [N m]
inline constexpr double kProbeHeadroom = 4.0;      // [1] of the device's largest force: saturation of the coupling

// Probes that collide with bodies in this world, in the registry's order.
std::vector<Entity> probe_tools(const World& world);
Handle6 probe_handle(const Probe& probe, const HapticDevice& device);
RigidMass probe_mass();
// Its spheres, of the shell's radius; none, if it has a capsule.
std::vector<SphereTip> tips_of(const Probe& probe, const Mesh& shell);

}  // namespace pliant
