// Where tangents begin, if nothing else says which way.
#pragma once

#include "components/math.h"

namespace pliant {

// The world axis that is farthest from a direction; of equals the first.
inline dvec3 farthest_axis(dvec3 from) {
  const dvec3 size = glm::abs(from);
  dvec3 axis(0.0);
  axis[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1.0;
  return axis;
}

}  // namespace pliant
