// `effects`: six plates that can be distinguished blind, each stroked by a finger of its own.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

Level effects();
// The level and its scripts.
Status write_effects(const std::filesystem::path& folder);

}  // namespace pliant::generate
