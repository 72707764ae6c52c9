// Levels with rigid bodies: a tower of boxes, and instruments on an organ.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

// A stylus presses on a tower of four wooden boxes and pushes the topmost onto two soft cubes.
Level stack();
// A stylus and a probe press and stroke a soft organ that lies on the ground.
Level instrument();

// The two levels and their scripts.
Status write_instrument_levels(const std::filesystem::path& folder);

}  // namespace pliant::generate
