// The drawn relief of a surface (normal and height maps) as a height that is felt: maps of heights over texture
// coordinates, and the coordinates of the touch mesh. Lifetime: as the mesh. Writer: content
// (content/mesh/relief_map.h).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "components/math.h"

namespace pliant {

// Heights at texel centres as coefficients of a quadratic B-spline: the sampled height is C1.
struct HeightMap {
  std::uint32_t width = 0, height = 0;
  std::vector<float> coefficient;  // [m] <= 0: the highest place of the map is on the mesh
  bool repeats_u = true, repeats_v = true;
  double wavelength = 0.0;  // [m] shortest that it can hold: two texels
  bool finer = false;       // it holds what the next level lacks

  struct Sample {
    double height = 0.0;  // [m]
    dvec2 slope{0};       // [m] d height / d uv
  };
  Sample at(dvec2 uv) const;
};

struct Relief {
  static constexpr std::uint8_t kNone = 0xff;
  std::vector<std::vector<HeightMap>> maps;    // each with its levels, every one of twice the wavelength of the last
  std::vector<std::uint8_t> map_of;            // per triangle: index into maps, or kNone
  std::vector<std::array<dvec2, 3>> uv;        // [1] per triangle, of its corners
  std::vector<std::array<float, 3>> strength;  // [1] per triangle, of its corners: 0 on a seam of the coordinates
};

}  // namespace pliant
