// The solids of the shipped levels. All in metres.
#pragma once

#include "content/author/solid.h"

namespace pliant::generate {

using namespace solids;  // solids, nets and instruments are made with both

// A smooth organ about 0.2 m wide: four blended lobes, and a groove down its front (+Z).
Solid organ();
// Relative depth in the groove at p: 1 on its bottom line, 0 well beside it.
double groove(dvec3 p);
// A pad 0.16 m x 0.04 m x 0.10 m with rounded sides and a gently curved top (+Y).
Solid pad();
// A plump heart 0.16 m wide, its point down, that faces +Z.
Solid heart();
// A square pillow 0.2 m x 0.07 m x 0.2 m, thin towards its edges.
Solid cushion();
// A ball 0.1 m wide with six soft ridges 3 mm high from pole to pole (+Y), the first at +Z.
Solid ridged_ball();

}  // namespace pliant::generate
