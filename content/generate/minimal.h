// The smallest level, for reading: JSON as a person would write it.
#pragma once

#include <filesystem>

#include "runtime/result.h"

namespace pliant::generate {

// minimal.gltf, minimal.bin and minimal.csv.
Status write_minimal(const std::filesystem::path& folder);

}  // namespace pliant::generate
