// The lists of systems, in order. Start reading at schedule.cpp.
#pragma once

#include <vector>

#include "components/world.h"
#include "runtime/schedule.h"

namespace pliant {

std::vector<System<World>> touch_schedule();  // 1 kHz
std::vector<System<World>> soft_schedule();   // every Simulation::soft_step, in levels with soft or rigid bodies

}  // namespace pliant
