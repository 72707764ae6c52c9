// A hand of a palm and three hinged fingers, closed by the grip of its device, takes up a soft ball.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

Level grasp();
// The level and its script.
Status write_grasp_level(const std::filesystem::path& folder);

}  // namespace pliant::generate
