// Layers and yielding, which belong to probes alone.
#pragma once

#include <optional>

#include "content/level/level.h"

namespace pliant {

// One note for all surfaces with `layers` or `yield` in a level whose soft or rigid bodies press surfaces.
std::optional<Note> undamaged_by_bodies(const Level& level);

}  // namespace pliant
