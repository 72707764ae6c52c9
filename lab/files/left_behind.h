// Files that a level names and that stay where they are when it is written somewhere else.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant {

// Files that PLIANT extensions name are not copied; where the level moves to another folder it misses them, and a note
// says so.
void say_left_behind(const Level& level, const std::filesystem::path& out);

}  // namespace pliant
