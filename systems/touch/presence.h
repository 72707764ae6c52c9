// Surfaces that whoever owns a run takes out, puts back or puts elsewhere between ticks. A surface that is taken out
// has an empty ObjectState::world_box. Touch clock; nothing here allocates.
#pragma once

#include "components/transform.h"
#include "components/world.h"

namespace pliant {

// What presses it lets go, and its dents come back. Out of the world, it meets nothing.
void take_out_surface(World& world, Entity surface);
// Where it is. What is inside of it then is not pushed: it is met when it comes in from outside.
void put_back_surface(World& world, Entity surface);
// Elsewhere, at rest; contacts end. Not of what a prescribed motion carries.
void place_surface(World& world, Entity surface, const Pose& pose);

}  // namespace pliant
