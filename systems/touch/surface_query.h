// Finding the place on a surface: globally (tree), locally (walk from the last place), along a segment, and by brute
// force for tests. All at rest geometry: heights are applied on top by the caller. Object frame, double.
#pragma once

#include "systems/touch/virtual_vertex.h"

namespace pliant {

// The virtual vertex with the smallest |height|; where there is none, or only one that is more than twice as far as the
// closest point (it belongs to another part of the surface), that closest point. Invalid if nothing is `within` [m].
SurfaceFoot nearest(const Mesh& mesh, dvec3 x, double within);
SurfaceFoot nearest_by_brute_force(const Mesh& mesh, dvec3 x, double within);

// Follows a surface point as x moves: walks over edges while the virtual vertex leaves a triangle, and where the walk
// stalls (crease, border, focal distance) searches the triangles around the last foot.
struct Tracked {
  SurfaceFoot point;
  bool left_border = false;  // x has moved past the rim of an open surface
};
Tracked track(const Mesh& mesh, const SurfaceFoot& last, dvec3 x);

// Where the segment first enters the surface (crosses a triangle from its outer side): fraction of the segment in [0,
// 1].
struct Entry {
  std::uint32_t triangle = SurfaceFoot::kNone;
  double fraction = 2.0;
  dvec3 barycentric{1, 0, 0};
  bool valid() const { return triangle != SurfaceFoot::kNone; }
};
Entry first_entry(const Mesh& mesh, dvec3 from, dvec3 to);

}  // namespace pliant
