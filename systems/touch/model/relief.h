// The drawn relief (components/relief.h) at a contact's place.
#pragma once

#include "components/relief.h"
#include "systems/touch/collide/foot_blend.h"

namespace pliant {

struct FeltRelief {
  double height = 0.0;  // [m] <= 0: the highest places are on the mesh
  dvec3 gradient{0};    // [1] by the tip's centre
  bool faded = false;   // detail was left out
};
// Without waves shorter than `finest` [m].
FeltRelief felt_relief(const Relief& relief, const FootBlend& place, double finest);

}  // namespace pliant
