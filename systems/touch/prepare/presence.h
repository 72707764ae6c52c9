// Removing, restoring and placing surfaces between ticks, by the owner of a run. A removed surface has an empty
// ObjectState::world_box. Touch clock; nothing here allocates.
#pragma once

#include "components/transform.h"
#include "components/world.h"

namespace pliant {

// Contacts with it end, and its dents recover. A removed surface has no contacts.
void take_out_surface(World& world, Entity surface);
// Restores it at its pose. Probes that are inside it are not pushed out; contact begins when they enter from outside.
void put_back_surface(World& world, Entity surface);
// Places it elsewhere, at rest; contacts end. Not for kinematic surfaces.
void place_surface(World& world, Entity surface, const Pose& pose);

}  // namespace pliant
