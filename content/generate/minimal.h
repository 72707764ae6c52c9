// The smallest level, as example: JSON as written by hand.
#pragma once

#include <filesystem>

#include "runtime/result.h"

namespace pliant::generate {

// Writes minimal.gltf, minimal.bin and minimal.csv.
Status write_minimal(const std::filesystem::path& folder);

}  // namespace pliant::generate
