// The tool in the touch tick: device pose -> 6-DoF handle at 1 kHz -> wrench for the device (methods.md 2.7-2.9).
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void tool_feedback(World& world, Tick tick);

}  // namespace pliant
