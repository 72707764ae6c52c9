// What a device renders stably is limited (DeviceCapabilities::max_stiffness), and what is touched may be stiffer. Then
// the hand gets as much less of the whole force as that is too stiff. To lower the slope between two ticks alone is not
// enough: at 1 kHz the ticks' forces themselves follow the stiff surface. To let the force rise slowly and fall fast,
// as a level's max_stiffness does (systems/safety), is passive in the tick and still shakes a device with a delay.
//
// A share of a passive force is passive while the share does not grow: it falls at once, and begins anew at 1 only
// where nothing is touched.
#pragma once

#include "components/world.h"
#include "systems/safety/safety.h"

namespace pliant {

// [N/m] per metre of the world: how steeply what this probe or tool feels grows with its pose, at most. Of a probe, the
// laws of its contacts along their normals; bristles are left out, since friction bounds what they give. Of a tool, its
// coupling.
double felt_stiffness(const World& world, Entity effector);

// Writes state.share for this tick. Before the force goes into the safety layer. [N/m] of the hand's metres: how
// steeply the share grows, at most (SafetyLimits::touched).
double soften(const World& world, Entity effector, const HapticDevice& device, SafetyState& state);

// Of a probe or tool that is prepared; null of others. Its force's.
SafetyState* safety_of(World& world, Entity hand);

}  // namespace pliant
