// A file of tetrahedra as a Level: its boundary as one mesh, for those who only want to see, convert or touch it.
#pragma once

#include "content/level/level.h"

namespace pliant {

Result<Level> import_tets(const std::filesystem::path& path);

}  // namespace pliant
