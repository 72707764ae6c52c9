// Detects point probes that pass through bodies, which only tools can touch.
#pragma once

#include <optional>
#include <string>

#include "components/world.h"

namespace pliant {

// A sentence if the level has point probes without anything to touch: no deformable surface at all, or none near the
// probes' paths but soft or rigid bodies. Call after paths are made.
std::optional<std::string> unfelt_bodies(const World& world);

}  // namespace pliant
