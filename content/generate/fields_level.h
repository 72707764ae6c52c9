// The level of effects in space.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

// A probe goes along a row of effects, one of each kind, and presses the board below them.
Level fields_level();

// The level, its script and its path.
Status write_fields_level(const std::filesystem::path& folder);

}  // namespace pliant::generate
