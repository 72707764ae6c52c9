// The built-in path `orbit`: approaches an object, presses, slides over it and leaves, repeatedly.
#pragma once

#include "components/haptic_device.h"
#include "components/world.h"

namespace pliant {

// A path over the world's deformables for the `index`-th orbiting probe of radius `radius` [m]; each has its place and
// phase. Call after prepare_touch; allocates. Returns an empty path where nothing can be touched.
Path make_orbit(const World& world, unsigned index, double radius);

// The same for a tool: from its initial pose onto the object below, along it, and back. It presses by a share of the
// tool's height.
Path make_tool_orbit(const World& world, Entity tool);

}  // namespace pliant
