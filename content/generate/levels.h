// The shipped levels, generated from the code in this folder alone.
#pragma once

#include <filesystem>

#include "content/level/level.h"

namespace pliant::generate {

// Mesh and picture resolution. The shipped files use the defaults; tests may use less.
struct Detail {
  int organ_coarse = 10, organ_doublings = 3;                          // 8 (10 * 2^3)^2 = 51,200 triangles
  int pad_coarse = 25, pad_doublings = 1;                              // 20,000 triangles
  int smooth_coarse = 12, smooth_doublings = 2;                        // 18,432 triangles: heart and cushion
  std::uint32_t color_size = 256, normal_size = 512, sky_width = 512;  // [px]
};

Level three_probes(const Detail& detail);
Level inclusion(const Detail& detail);
Level glass_heart(const Detail& detail);
Level chrome_cushion(const Detail& detail);
Level turning_ball(const Detail& detail);

// Writes all shipped files, levels/ and environments/, below `folder`. Each is written atomically.
Status generate(const std::filesystem::path& folder, const Detail& detail = {});

}  // namespace pliant::generate
