// Everything that `pliant validate` says of a level.
#pragma once

#include <filesystem>

#include "content/level/finding.h"

namespace pliant {

// The document against glTF 2.0, the PLIANT_* extensions against their table, then what only shows when meshes are
// built: each step relies on the one before. All findings, not only the first; the level can be loaded if none is an
// error.
Findings validate_level(const std::filesystem::path& path);

}  // namespace pliant
