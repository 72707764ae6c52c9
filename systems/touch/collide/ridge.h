// The ridge between two contacts of one sphere (of a capsule: capsule.h): the least depth on the way along the surface
// from one foot to the other. Contacts whose ridge is inside the sphere are parts of one dent: at the ridge's depth
// they are the same, and only what is deeper is each one's own (contact_energy.h). A local minimum therefore appears
// and vanishes without a step.
#pragma once

#include "systems/touch/collide/foot_blend.h"

namespace pliant {

struct Ridge {
  double depth = 0.0;  // [m] below the sphere's surface; 0: the contacts are apart
  dvec3 slope{0};      // [1] d depth / dx
  dvec3 x{0};          // [m] centre of the sphere
};

// The way is the section of the flat triangles by the plane through both feet and x, and a better one beside it, if
// there is one. x [m], object frame.
Ridge ridge_between(const Mesh& mesh, const FootBlend& a, const FootBlend& b, dvec3 x, double radius);

}  // namespace pliant
