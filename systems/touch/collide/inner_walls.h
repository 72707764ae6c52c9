// Inner walls: the side walls of a crack, which the surface across the crack covers. Nothing reaches them from outside.
#pragma once

#include "components/world.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {

// The triangles of an object that another surface covers while a seam is closed, connected to the seam: those behind
// the surface that ends there, with a triangle of the other at all their corners that faces them at most as far
// as a crack is wide. The seams are known. Allocates.
void find_inner_walls(const World& world, TouchState& touch, std::uint32_t slot);

// Whether the triangle is one of those now.
bool is_inner_wall(const ObjectState& object, std::uint32_t triangle);

}  // namespace pliant
