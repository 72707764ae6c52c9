// OpenEXR panoramas.
#pragma once

#include <filesystem>

#include "components/appearance.h"
#include "runtime/result.h"

namespace pliant {

// Reads a latitude-longitude panorama: linear RGB, rows top (+Y) to bottom. Errors name the file.
Result<Panorama> load_panorama(const std::filesystem::path& path);

}  // namespace pliant
