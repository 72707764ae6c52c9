// What a touch tick and a frame cost, by how many vertices a surface has and how many of them move.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pliant {

struct TickCost {
  std::uint32_t vertices = 0, triangles = 0;
  double awake = 0.0;                              // vertices, mean
  double p50_us = 0.0, p99_us = 0.0;               // of a tick, processor time, the least of the batches
  std::vector<double> batch_p50_us, batch_p99_us;  // the same of each batch
  double frame_us = 0.0;  // of publishing a snapshot for the picture, every 16 ticks, median, the least of the batches
  double drawn_us = 0.0;  // of a drawn frame, median; 0: none was
  std::string not_drawn;  // why, where one was asked for
  double bytes = 0.0;     // touch state, a vertex
};

// Frames of 16 ticks each, after the ticks.
struct DrawnCount {
  int frames = 0;        // [1] above 0 a current OpenGL context is needed
  bool with_cpu = true;  // how they are measured: drawn_frame.h
};

// A probe slides over a sphere of about so many vertices, a third of an edge a tick; its reach keeps about
// `awake` of them moving. `batches` share the ticks; the least of their figures counts, because what else runs on the
// machine disturbs few of them.
TickCost measure_tick(std::uint32_t vertices, std::uint32_t awake, int ticks, int batches = 4, DrawnCount drawn = {});

}  // namespace pliant
