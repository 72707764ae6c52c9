// What a solid body of unit density weighs, where its weight sits and how it resists turning, from its closed surface.
#pragma once

#include "components/mesh.h"

namespace pliant {

struct MassProperties {
  double volume = 0.0;  // [m3] >= 0
  dvec3 centre{0};      // [m] object frame
  dmat3 inertia{0.0};   // [m5] about the centre, object axes, for 1 kg/m3: times density it is [kg m2]
};

// Exact for a closed surface, whichever way it faces; the small holes of one that is almost closed are bridged towards
// the middle of its box. All zero where nothing is enclosed.
MassProperties mass_properties(const Mesh& mesh);

}  // namespace pliant
