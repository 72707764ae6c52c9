// The levels of the second system: a hand of flesh on a rigid bone, led along a path in all six degrees of freedom.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

// Presses and strokes a soft organ that lies on the ground, with friction, and rolls on it.
Level hand();
// Presses on a soft cube that stands on a tray, and on two soft balls in their cups.
Level hand_crowd();
// Pushes its fingers between two walls, until they touch one another.
Level hand_squeeze();

// The three levels and their scripts.
Status write_tool_levels(const std::filesystem::path& folder);

}  // namespace pliant::generate
