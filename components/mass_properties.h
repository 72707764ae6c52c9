// Volume, centre of mass and inertia of a solid of unit density, from its closed surface.
#pragma once

#include "components/mesh.h"

namespace pliant {

struct MassProperties {
  double volume = 0.0;  // [m3] >= 0
  dvec3 centre{0};      // [m] object frame
  dmat3 inertia{0.0};   // [m5] about the centre, object axes, for 1 kg/m3: times density it is [kg m2]
};

// Exact for a closed surface of either orientation. Small holes of an almost closed surface are bridged towards the
// middle of its box. All zero where nothing is enclosed.
MassProperties mass_properties(const Mesh& mesh);

}  // namespace pliant
