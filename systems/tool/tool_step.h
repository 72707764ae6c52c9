// The systems of the soft schedule (systems/schedule.cpp) that are about tools, and how that schedule is run: a handle
// that goes fast takes a soft step in shorter parts.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"
#include "runtime/schedule.h"

namespace pliant {

// One soft step by the soft schedule: as a rule one run of it. Models are published at its end.
void run_soft_step(Schedule<World>& schedule, World& world, Tick tick);

void read_tool_input(World& world, Tick tick);  // where the hands are
void linearise_tools(World& world, Tick tick);  // what the touch tick will take for the tool's tissue
void publish_tools(World& world, Tick tick);    // HandleModel -> touch clock

}  // namespace pliant
