// Files that a level refers to and that are not copied when the level is written to another folder.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant {

// Files referred to by PLIANT extensions are not copied. If the level moves to another folder, a note lists those that
// it will miss there.
void say_left_behind(const Level& level, const std::filesystem::path& out);

}  // namespace pliant
