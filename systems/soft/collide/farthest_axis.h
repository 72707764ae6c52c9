// Start direction of tangents, in the absence of another.
#pragma once

#include "components/math.h"

namespace pliant {

// The world axis farthest from a direction; the first of equals.
inline dvec3 farthest_axis(dvec3 from) {
  const dvec3 size = glm::abs(from);
  dvec3 axis(0.0);
  axis[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1.0;
  return axis;
}

}  // namespace pliant
