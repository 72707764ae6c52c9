// The shipped environments: a soft sky, and a terrace under clouds.
#pragma once

#include <filesystem>

#include "components/appearance.h"
#include "runtime/result.h"

namespace pliant::generate {

// A latitude-longitude sky: pale horizon, blue zenith, a warm sun in a wide glow, soft ground. Linear RGB.
Panorama sky(std::uint32_t width);
// The same sun and sky with clouds, above a tiled floor. The tile lines make reflection and refraction visible.
Panorama terrace(std::uint32_t width);
// As OpenEXR, half floats, ZIP.
Status save_panorama(const Panorama& panorama, const std::filesystem::path& path);

}  // namespace pliant::generate
