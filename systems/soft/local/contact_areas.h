// Shares of a pressed patch's area, one for each contact in it: the radii of split contacts (methods.md 2.10).
#pragma once

#include <vector>

#include "components/math.h"

namespace pliant {

struct PressedPoint {
  dvec3 at{0};            // [m]
  dvec3 normal{0, 1, 0};  // [1]
};

struct PressedShare {
  double area = 0.0;  // [m2]
  dvec3 middle{0};    // [m] of the area, from the point: a point on the patch's rim has its area on one side
};

// For each point the part of its plane that is nearest to it among the points that face like it, within their convex
// hull, so that the shares add up to the patch's area; no farther than its sixth neighbour, so that two patches do not
// share what is between them. A point without neighbours, or in a row, has `alone` [m2].
std::vector<PressedShare> shares_of_area(const std::vector<PressedPoint>& points, double alone);

}  // namespace pliant
