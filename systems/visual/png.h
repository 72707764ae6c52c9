// Image files.
#pragma once

#include <filesystem>

#include "components/appearance.h"
#include "runtime/result.h"

namespace pliant {

// Writes a PNG to a temporary file and renames it, so that a reader never sees half a picture. The folder must exist.
Status write_png(const Image& image, const std::filesystem::path& path);

}  // namespace pliant
