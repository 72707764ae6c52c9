// What a point probe passes through: bodies that only tools touch.
#pragma once

#include <optional>
#include <string>

#include "components/world.h"

namespace pliant {

// A sentence where the level has point probes but nothing for them: no deformable surface at all, or none where a
// probe's path goes, but soft or rigid bodies. Call after paths are made.
std::optional<std::string> unfelt_bodies(const World& world);

}  // namespace pliant
