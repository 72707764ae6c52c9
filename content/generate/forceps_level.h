// The level `forceps`: jaws, closed by the grip, take a vessel and peel it off its bed.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

Level forceps();
// forceps.glb, and the script of the jaws beside it.
Status write_forceps_level(const std::filesystem::path& folder);

}  // namespace pliant::generate
