// Cost of a touch tick and of a frame, over the vertices of a surface and the number of moving ones.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pliant {

struct TickCost {
  std::uint32_t vertices = 0, triangles = 0;
  double awake = 0.0;                              // vertices, mean
  double p50_us = 0.0, p99_us = 0.0;               // per tick, CPU time, minimum over the batches
  std::vector<double> batch_p50_us, batch_p99_us;  // the same per batch
  double frame_us = 0.0;  // publishing a snapshot for the picture, every 16 ticks: median, minimum over the batches
  double drawn_us = 0.0;  // median of a drawn frame; 0: none was drawn
  std::string not_drawn;  // the reason, if one was requested
  double bytes = 0.0;     // touch state per vertex
};

// Frames of 16 ticks each, drawn after the ticks.
struct DrawnCount {
  int frames = 0;        // above 0 a current OpenGL context is needed
  bool with_cpu = true;  // how they are measured: drawn_frame.h
};

// A probe slides over a sphere of about that many vertices, a third of an edge per tick; its reach keeps about `awake`
// of them moving. The ticks are divided into `batches`. The minimum over the batches is taken, because other work on
// the machine disturbs only a few of them.
TickCost measure_tick(std::uint32_t vertices, std::uint32_t awake, int ticks, int batches = 4, DrawnCount drawn = {});

}  // namespace pliant
