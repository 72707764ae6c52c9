// Pictures into files.
#pragma once

#include <filesystem>

#include "components/appearance.h"
#include "runtime/result.h"

namespace pliant {

// Writes a PNG beside its place and then renames it, so that a reader never sees half a picture. The folder must exist.
Status write_png(const Image& image, const std::filesystem::path& path);

}  // namespace pliant
