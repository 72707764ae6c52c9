// Prescribes a tool's device for the next soft step, without a touch clock: for studies of the soft step itself.
#pragma once

#include "components/world.h"
#include "systems/soft/body/handle.h"

namespace pliant {

// Moves the device of the world's first tool from `before` to `now` in a step of T [s] that ends at `time` [s].
// `handle`: the tool's handle at that time, if known; otherwise it follows the device.
void drive_tool(World& world, const Pose& now, const Pose& before, double T, double time,
                const RigidMotion* handle = nullptr);

}  // namespace pliant
