// The surroundings as a cube map for the GPU. Level k contains the radiance that a coat of roughness k / (levels - 1)
// gathers about each direction (the first factor of the split sum: Karis, Real Shading in Unreal Engine 4, 2013).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "components/appearance.h"

namespace pliant {

inline constexpr std::uint32_t kCubeLevels = 6;

struct Cube {
  std::uint32_t face = 0;          // [pixels] an edge of level 0, a power of two of at least 2^(kCubeLevels - 1)
  std::vector<std::uint16_t> rgb;  // [cd/m2, relative] half floats; level by level, face by face (+X -X +Y -Y +Z -Z)
};

// Number of values in such a cube.
std::size_t cube_size(std::uint32_t face);
// Unit direction through the middle of a pixel of a face with `size` pixels an edge.
vec3 cube_direction(unsigned face, std::uint32_t x, std::uint32_t y, std::uint32_t size);

// The panorama averaged over whole blocks of pixels, at most `widest` wide.
Panorama scaled_down(const Panorama& panorama, std::uint32_t widest);
// Filters a non-empty panorama, on several threads. Keeps its frame: the middle column is towards -Z.
Cube filtered_cube(const Panorama& panorama);

// The same, cached in the folder $XDG_CACHE_HOME/pliant (else ~/.cache/pliant). An incomplete or corrupt file is made
// again; failure to write is ignored.
Cube cached_cube(const Panorama& panorama);

}  // namespace pliant
