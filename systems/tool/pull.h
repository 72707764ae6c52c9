// Pulling bodies by the mouse (ProbeHold): a spring and damper between a patch of a body's surface and the probe's
// device, by the probe's own `coupling`, no harder than the device's `max_force`. A patch, as two fingers take hold of
// tissue: a single node of a soft lattice would be drawn out to a thorn. Implicit over the soft step, exactly: with W
// the compliance of the patch (J A^-1 J^T) and v* its velocity without the spring,
//   lambda = (1 + (T b + T^2 k) W)^-1 T (k (x_d - x - T v*) + b (v_d - v*)),
// so that no stiffness makes it unstable, however light the body is. The spring is relaxed when it is taken away: what
// was pulled swings on with what it had.
#pragma once

#include "components/world.h"
#include "runtime/schedule.h"

namespace pliant {

// Tunables. Unit, usual value, and what changing it does.
inline constexpr double kPullPatch = 0.04;    // [1] of the body's diagonal: radius of the patch of a soft body
inline constexpr double kPullComesIn = 0.15;  // [s] over which the spring comes in; shorter: taking hold jerks

// [N] of a spring of `stiffness` [N/m] at a stretch [m], saturated as a coupling's is.
dvec3 pull_force(dvec3 stretch, double stiffness, double most);

// Soft clock, between free_motion and find_contacts.
void pull_bodies(World& world, Tick tick);

}  // namespace pliant
