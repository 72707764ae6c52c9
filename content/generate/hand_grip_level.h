// `hand_grip`: a hand of tissue on fifteen bones closes by its grip on a soft ball, lifts and tilts it.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

Result<Level> hand_grip();
// The level and its script.
Status write_hand_grip_level(const std::filesystem::path& folder);

}  // namespace pliant::generate
