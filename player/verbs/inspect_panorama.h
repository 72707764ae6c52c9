// What `pliant inspect` says of an OpenEXR panorama.
#pragma once

#include <filesystem>

namespace pliant {

bool is_panorama_file(const std::filesystem::path& path);
int inspect_panorama(const std::filesystem::path& path, bool as_json);

}  // namespace pliant
