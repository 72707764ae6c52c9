// Instruments as closed tubes with few triangles.
#pragma once

#include <vector>

#include "content/author/surface_nets.h"

namespace pliant::solids {

struct TubeRing {
  dvec3 centre, along;  // [m]; unit, towards the next ring
  double radius;        // [m]
};

// Joins rings into a closed tube with a vertex at either end. All axes lie in the plane x = 0.
Net tube(dvec3 start, const std::vector<TubeRing>& rings, dvec3 end);

}  // namespace pliant::solids
