// The surroundings as the GPU wants them: a cube map whose level k holds what a coat of roughness k / (levels - 1)
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

// How many numbers such a cube holds.
std::size_t cube_size(std::uint32_t face);
// Unit direction through the middle of a pixel of a face with `size` pixels an edge.
vec3 cube_direction(unsigned face, std::uint32_t x, std::uint32_t y, std::uint32_t size);

// The panorama averaged over whole blocks of pixels, so that it is at most `widest` wide.
Panorama scaled_down(const Panorama& panorama, std::uint32_t widest);
// Filters a panorama that is not empty, on several threads. Its frame stays: the middle column lies towards -Z.
Cube filtered_cube(const Panorama& panorama);

// The same, from the folder $XDG_CACHE_HOME/pliant (else ~/.cache/pliant) where this panorama has been filtered before.
// A file there that is not whole and sound is made again; one that cannot be written is done without.
Cube cached_cube(const Panorama& panorama);

}  // namespace pliant
