// The part of `pliant inspect` for OpenEXR panoramas.
#pragma once

#include <filesystem>

namespace pliant {

bool is_panorama_file(const std::filesystem::path& path);
int inspect_panorama(const std::filesystem::path& path, bool as_json);

}  // namespace pliant
