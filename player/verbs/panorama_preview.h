// A latitude-longitude panorama as the six faces of a cube, laid out as a cross, for visual inspection.
#pragma once

#include "components/appearance.h"

namespace pliant {

// 4 x 3 squares of `face` pixels: +Y on top; -X, +Z, +X, -Z in the middle; -Y at the bottom; the rest is transparent.
// Exposed so that the mean luminance becomes middle grey, compressed (x / (1 + x)), and sRGB encoded.
Image cube_cross(const Panorama& panorama, std::uint32_t face);

}  // namespace pliant
