// Solids as implicit functions: negative inside, positive outside, approximately a distance near the surface. In
// metres.
#pragma once

#include <functional>

#include "components/math.h"

namespace pliant::solids {

using Solid = std::function<double(dvec3)>;

// Outward unit normal of the level set through p.
dvec3 normal_at(const Solid& solid, dvec3 p);
// The nearby surface point found from p by Newton steps along the gradient.
dvec3 project(const Solid& solid, dvec3 p);

}  // namespace pliant::solids
