// Pulling bodies by the mouse (ProbeHold). A spring and damper connect a patch of a body's surface to the probe's
// device. They use the probe's `coupling`; the force is at most the device's `max_force`. A patch rather than a node: a
// single node of a soft lattice would be drawn out to a spike. The step is implicit over the soft step, and exact. W is
// the compliance of the patch (J A^-1 J^T), v* its velocity without the spring:
//   lambda = (1 + (T b + T^2 k) W)^-1 T (k (x_d - x - T v*) + b (v_d - v*)),
// which is stable for any stiffness and any mass of the body. On release the spring is removed; the body keeps its
// velocity.
#pragma once

#include "components/world.h"
#include "runtime/schedule.h"
#include "systems/soft/body/body.h"

namespace pliant {

// Tunables. Unit, usual value, and what changing it does.
inline constexpr double kPullPatch = 0.04;    // [1] of the body's diagonal: radius of the patch of a soft body
inline constexpr double kPullComesIn = 0.15;  // [s] ramp of the spring; shorter: grabbing a body jerks

// [N] of a spring of `stiffness` [N/m] at a stretch [m], saturated like a coupling.
dvec3 pull_force(dvec3 stretch, double stiffness, double most);

// The point of the body's current surface nearest to `p` [m] world.
SurfacePoint nearest_on(const Body& body, dvec3 p);

// Soft clock, between free_motion and find_contacts.
void pull_bodies(World& world, Tick tick);

}  // namespace pliant
