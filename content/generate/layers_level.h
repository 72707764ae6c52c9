// `layers`: a needle goes through skin and ligament and finds its hole again; a finger leaves dents in clay.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

Level layers_level();
// The level and its scripts.
Status write_layers_level(const std::filesystem::path& folder);

}  // namespace pliant::generate
