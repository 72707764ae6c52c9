// The tool systems of the soft schedule (systems/schedule.cpp), and the way that schedule is run: fast motions of a
// handle split a soft step into shorter parts.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"
#include "runtime/schedule.h"

namespace pliant {

// One soft step by the soft schedule: usually one run of it. Models are published at its end.
void run_soft_step(Schedule<World>& schedule, World& world, Tick tick);

void read_tool_input(World& world, Tick tick);  // target poses of the handles
void linearise_tools(World& world, Tick tick);  // the tissue model for the touch tick
void publish_tools(World& world, Tick tick);    // HandleModel -> touch clock

}  // namespace pliant
