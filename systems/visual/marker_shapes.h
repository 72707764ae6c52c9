// The unit shapes of markers: a ball about the origin, and a rod and a cone from y = 0 to y = 1. All have radius 1 and
// are counter-clockwise seen from outside.
#pragma once

#include <cstdint>
#include <vector>

#include "components/math.h"

namespace pliant {

struct MarkerVertex {
  vec3 position{0}, normal{0};
};

struct MarkerMesh {
  std::vector<MarkerVertex> vertices;
  std::vector<std::uint32_t> indices;
};

MarkerMesh make_ball();
MarkerMesh make_rod();   // with a flat cap at y = 1
MarkerMesh make_cone();  // tip at y = 1, flat cap at y = 0

}  // namespace pliant
