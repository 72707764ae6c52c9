// The region of space to fill with tetrahedra, given a surface and the author's options.
#pragma once

#include "content/tets/lattice_inside.h"
#include "content/tets/surface_shape.h"
#include "pliant/parameters.h"

namespace pliant {

class FillRegion {
 public:
  // `thickness` [m] of a wall; 0: measured from the surface. Keeps references to the arguments.
  FillRegion(const Mesh& surface, const Inside& inside, const SurfaceShape& shape, Fill fill, double thickness);

  // [m] Contains the region.
  Box box() const;
  bool operator()(dvec3 p) const;
  // Whether it is what the surface encloses, no more and no less.
  bool is_enclosed() const { return how_ == How::kEnclosed; }
  // Whether a box is known to be entirely inside or entirely outside.
  bool is_uniform(dvec3 low, dvec3 high) const { return how_ == How::kEnclosed && inside_.is_uniform(low, high); }
  // The boundary crossing between a point inside and one outside: share [1] of the way.
  double crossing(dvec3 inside, dvec3 outside) const;
  // [m] Thickness of the region from a surface point straight inward; 0: none.
  double thickness_at(const ThicknessSample& sample) const;

 private:
  // The wall with its cavity: points inside the wall, and points from which most rays cross it once. Wide openings are
  // closed like a soap film, so the surface need not be watertight.
  bool in_hull(dvec3 p) const { return inside_(p) || enclosed_share(p) > 0.5; }
  double enclosed_share(dvec3 p) const;
  bool behind_sheet(dvec3 p) const;

  enum class How : std::uint8_t {
    kEnclosed,  // the interior of the surface
    kHull,      // the interior, and the cavity of its wall
    kLayer,     // of that, the part within `thickness` of the surface
    kSheet,     // the part within `thickness` behind an open sheet
  };
  const Mesh& surface_;
  const Inside& inside_;
  How how_ = How::kEnclosed;
  bool hollow_ = false;
  double thickness_ = 0.0;  // [m]
  double thickest_ = 0.0;   // [m] the largest thickness that counts as a wall
};

}  // namespace pliant
