// Straight ways through a surface: what of its triangles they meet. For loading and looking at files, not for ticks;
// Mesh::tree's boxes, double precision.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "components/mesh.h"

namespace pliant {

// Adds the shares [1] of the way from + s along, s in [0, 1], at which it meets triangles; in no order.
void find_hits(const Mesh& surface, dvec3 from, dvec3 along, std::vector<double>& shares);

struct RayHit {
  double share = std::numeric_limits<double>::infinity();  // [1] of the way; infinite: nothing is met
  std::uint32_t triangle = kBorder;

  bool met() const { return triangle != kBorder; }
};
// The first one beyond the share `after`.
RayHit first_hit(const Mesh& surface, dvec3 from, dvec3 along, double after);
// [1] Which share of all directions leads from p through an odd number of walls: 1 in the closed cavity of a thin wall,
// 0 outside of it, in between near its openings. A wall is entered and left again within `thickest` [m], along its
// normal; what is thicker is solid and counts as two. Few directions answer where they all agree.
double enclosed_share(const Mesh& surface, dvec3 p, double thickest);

// The point of the surface closest to p.
struct RayPoint {
  dvec3 place{0};                                             // [m]
  double distance = std::numeric_limits<double>::infinity();  // [m]
  std::uint32_t triangle = kBorder;
};
// Nothing where none is within `reach` [m].
RayPoint closest_of(const Mesh& surface, dvec3 p, double reach = std::numeric_limits<double>::infinity());

// Ericson, "Real-Time Collision Detection" (2005), 5.1.5.
dvec3 closest_on_triangle(dvec3 p, dvec3 a, dvec3 b, dvec3 c);

}  // namespace pliant
