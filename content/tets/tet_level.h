// A tetrahedra file as a Level with its boundary as one mesh, for showing, converting or touching it.
#pragma once

#include "content/level/level.h"

namespace pliant {

Result<Level> import_tets(const std::filesystem::path& path);

}  // namespace pliant
