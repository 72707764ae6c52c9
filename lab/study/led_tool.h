// Where the next soft step has a tool's device, without a touch clock: for studies of the soft step itself.
#pragma once

#include "components/world.h"
#include "systems/soft/body/handle.h"

namespace pliant {

// The device of the world's first tool goes from `before` to `now` in a step of T [s] that ends at `time` [s].
// `handle`: where the tool's handle is then, if that is known; otherwise it follows the device.
void lead_tool(World& world, const Pose& now, const Pose& before, double T, double time,
               const RigidMotion* handle = nullptr);

}  // namespace pliant
