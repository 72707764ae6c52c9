// What a touch tick costs, by how many vertices a surface has and how many of them move.
#pragma once

#include <cstdint>

namespace pliant {

struct TickCost {
  std::uint32_t vertices = 0, triangles = 0;
  double awake = 0.0;                 // vertices, mean
  double p50_us = 0.0, p99_us = 0.0;  // of a tick, processor time, the least of four batches
  double frame_us = 0.0;              // of what is told to the picture, every 16 ticks, median
  double bytes = 0.0;                 // touch state, a vertex
};

// A probe slides over a sphere of about so many vertices, a third of an edge a tick; its reach keeps about
// `awake` of them moving.
TickCost measure_tick(std::uint32_t vertices, std::uint32_t awake, int ticks);

}  // namespace pliant
