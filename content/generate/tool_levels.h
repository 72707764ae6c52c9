// The levels of the second system: a soft hand on a rigid bone, driven along a 6-DoF path.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

// The hand presses, strokes and rolls on a soft organ that lies on the ground, with friction.
Level hand();
// The hand presses on a soft cube on a tray, and on two soft balls in their cups.
Level hand_crowd();
// The hand pushes its fingers between two walls until they touch one another.
Level hand_squeeze();

// The three levels and their scripts.
Status write_tool_levels(const std::filesystem::path& folder);

}  // namespace pliant::generate
