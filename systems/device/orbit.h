// The built-in path `orbit`: approaches an object, presses, slides over it and leaves, again and again.
#pragma once

#include "components/haptic_device.h"
#include "components/world.h"

namespace pliant {

// A path over the world's deformables for the `index`-th orbiting probe of radius `radius` [m] (each takes its own
// place and phase). Call after prepare_touch; allocates. An empty path where nothing can be touched.
Path make_orbit(const World& world, unsigned index, double radius);

// The same for a tool: from where the level put it down onto what lies below, along it, and back. It presses by a share
// of the tool's own height.
Path make_tool_orbit(const World& world, Entity tool);

}  // namespace pliant
