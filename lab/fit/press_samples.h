// Places on a smooth surface (components/curved_patch.h), and the sample points around them at which a press is
// measured.
#pragma once

#include <vector>

#include "components/mesh.h"

namespace pliant {

// A place on the curved surface, object frame.
struct PressPlace {
  std::uint32_t triangle = 0;
  dvec3 barycentric{1, 0, 0};
  dvec3 position{0};      // [m]
  dvec3 normal{0, 1, 0};  // [1] unit, outward
};
PressPlace place_at(const Mesh& mesh, std::uint32_t triangle, dvec3 barycentric);

struct PlacedSample : PressPlace {
  double area = 0.0;  // [m2] represented by the sample
};
// Samples of the curved patches with a spacing of about `apart` [m]: all points within `within` [m] of the place whose
// normals face the same way (the opposite side of the object is another surface).
std::vector<PlacedSample> samples_around(const Mesh& mesh, const PressPlace& place, double within, double apart);

}  // namespace pliant
