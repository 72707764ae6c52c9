// The level of a lump that is found by touch.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

// Where the lump is in the pad: its centre, the pad's top at y = 0, and its radius. [m]
inline constexpr dvec3 kLump{0.012, -0.0118, -0.006};
inline constexpr double kLumpRadius = 0.0085;

// A finger presses row by row on a pad of soft tissue; a lump inside is twenty times as stiff, and not to be seen.
Level palpation();

// The level and its path.
Status write_palpation_level(const std::filesystem::path& folder);

}  // namespace pliant::generate
