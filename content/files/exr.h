// OpenEXR panoramas.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "components/appearance.h"
#include "runtime/result.h"

namespace pliant {

inline constexpr std::uint32_t kMaxPanoramaWidth = 8192, kMaxPanoramaHeight = 8192;  // [px]

// Reads a latitude-longitude panorama: linear RGB, rows top (+Y) to bottom. Luminance and luminance-chroma files are
// converted to RGB. NaN, infinite and negative values become 0 and are counted in a note. Errors name the file.
Result<Panorama> load_panorama(const std::filesystem::path& path, std::vector<std::string>* notes = nullptr);

// Loads the panorama that a level in `folder` names. It lies in that folder, or in `environments` beside it, where the
// shipped ones are. A level can reach no other folder (confined_path).
Result<Panorama> load_named_panorama(const std::filesystem::path& folder, const std::string& name,
                                     std::vector<std::string>* notes = nullptr);

// The same from memory; errors begin with `name`.
Result<Panorama> decode_panorama(std::span<const std::uint8_t> bytes, const std::string& name,
                                 std::vector<std::string>* notes = nullptr);

}  // namespace pliant
