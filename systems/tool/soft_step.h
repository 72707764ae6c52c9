// The systems of the soft schedule (systems/schedule.cpp), in order. Each does nothing in a world without soft or rigid
// bodies. Tick::dt is the step T [s]; each notes what it cost in SoftTimes.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"
#include "runtime/schedule.h"

namespace pliant {

// [m] The way that a handle goes in one soft step; a faster one goes it in up to kMostParts shorter steps. A finger's
// width must not be passed in one.
inline constexpr double kMostWay = 0.01;
inline constexpr int kMostParts = 8;

// One soft step by the soft schedule: as a rule one run of it. Models are published at its end.
void run_soft_step(Schedule<World>& schedule, World& world, Tick tick);

void read_tool_input(World& world, Tick tick);  // where the hands are
void free_motion(World& world, Tick tick);      // v* of every body, without contacts; skin velocities
void find_contacts(World& world, Tick tick);    // pairs of skin points that may touch within the step
void solve_contacts(World& world, Tick tick);   // impulses, and v = v* + A^-1 J^T lambda
void linearise_tools(World& world, Tick tick);  // what the touch tick will take for the tool's flesh
void advance_bodies(World& world, Tick tick);   // x += T v; surfaces give way
void publish_tools(World& world, Tick tick);    // HandleModel -> touch clock

}  // namespace pliant
