// Intersects rays with a surface. For loading and inspecting files, not for ticks. Uses the boxes of Mesh::tree, in
// double precision.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "components/mesh.h"

namespace pliant {

// Appends the shares [1] of the segment from + s along, s in [0, 1], at which it meets triangles; unordered.
void find_hits(const Mesh& surface, dvec3 from, dvec3 along, std::vector<double>& shares);

struct RayHit {
  double share = std::numeric_limits<double>::infinity();  // [1] of the way; infinite: no hit
  std::uint32_t triangle = kBorder;

  bool met() const { return triangle != kBorder; }
};
// The first one beyond the share `after`.
RayHit first_hit(const Mesh& surface, dvec3 from, dvec3 along, double after);
// [1] Share of directions in which a ray from p crosses an odd number of walls: 1 in the closed cavity of a thin wall,
// 0 outside of it, in between near its openings. A wall is entered and left within `thickest` [m] along its normal; a
// thicker object is solid and counts as two. Fewer directions are used if the first ones agree.
double enclosed_share(const Mesh& surface, dvec3 p, double thickest);

// The point of the surface closest to p.
struct RayPoint {
  dvec3 place{0};                                             // [m]
  double distance = std::numeric_limits<double>::infinity();  // [m]
  std::uint32_t triangle = kBorder;
};
// Empty if none is within `reach` [m].
RayPoint closest_of(const Mesh& surface, dvec3 p, double reach = std::numeric_limits<double>::infinity());

// Ericson, "Real-Time Collision Detection" (2005), 5.1.5.
dvec3 closest_on_triangle(dvec3 p, dvec3 a, dvec3 b, dvec3 c);

}  // namespace pliant
