// The systems of the soft schedule (systems/schedule.cpp) for bodies, in order. Each does nothing in a world without
// soft or rigid bodies. Tick::dt is the step T [s]; each records its cost in SoftTimes.
#pragma once

#include "components/world.h"
#include "runtime/clock.h"

namespace pliant {

void take_edits(World& world, Tick tick);      // ParameterEdit -> bodies, including yielding surfaces
void free_motion(World& world, Tick tick);     // v* of every body, without contacts; collision mesh velocities
void find_contacts(World& world, Tick tick);   // pairs of collision mesh points that may touch within the step
void solve_contacts(World& world, Tick tick);  // impulses, and v = v* + A^-1 J^T lambda
void advance_bodies(World& world, Tick tick);  // x += T v; displaces yielding surfaces

}  // namespace pliant
