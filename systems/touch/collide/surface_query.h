// Point location on a surface: global (tree), local (walk from the last place), along a segment, and by brute force for
// tests. Rest geometry only; the caller adds heights. Object frame, double.
#pragma once

#include "systems/touch/collide/virtual_vertex.h"

namespace pliant {

// The virtual vertex with the smallest |height|. If there is none, or it is more than twice as far as the closest point
// (it is on another part of the surface), returns the closest point. Invalid if nothing is `within` [m].
SurfaceFoot nearest(const Mesh& mesh, dvec3 x, double within);
SurfaceFoot nearest_by_brute_force(const Mesh& mesh, dvec3 x, double within);

// Tracks a surface point as x moves. Walks over edges while the virtual vertex leaves a triangle; where the walk stalls
// (crease, border, focal distance), searches the triangles around the last foot.
struct Tracked {
  SurfaceFoot point;
  bool left_border = false;  // x has moved past the rim of an open surface
};
Tracked track(const Mesh& mesh, const SurfaceFoot& last, dvec3 x);

// First entry of the segment into the surface (crossing of a triangle from its outer side): fraction of the segment in
// [0, 1].
struct Entry {
  std::uint32_t triangle = SurfaceFoot::kNone;
  double fraction = 2.0;
  dvec3 barycentric{1, 0, 0};
  bool valid() const { return triangle != SurfaceFoot::kNone; }
};
Entry first_entry(const Mesh& mesh, dvec3 from, dvec3 to);

}  // namespace pliant
