// What of space is to be filled with tetrahedra, for a surface and what its author wants of it.
#pragma once

#include "content/tets/lattice_inside.h"
#include "content/tets/surface_shape.h"
#include "pliant/parameters.h"

namespace pliant {

class FillRegion {
 public:
  // `thickness` [m] of a wall; 0: as the surface has it. References are kept.
  FillRegion(const Mesh& surface, const Inside& inside, const SurfaceShape& shape, Fill fill, double thickness);

  // [m] No place of it lies outside of this.
  Box box() const;
  bool operator()(dvec3 p) const;
  // Whether all of a box is known to be in it, or all outside.
  bool is_uniform(dvec3 low, dvec3 high) const { return how_ == How::kEnclosed && inside_.is_uniform(low, high); }
  // Where one leaves between a point of it and one outside: share [1] of the way.
  double crossing(dvec3 inside, dvec3 outside) const;
  // [m] of it from a place of the surface straight inward; 0: nothing of it lies there.
  double thickness_at(const ThicknessSample& sample) const;

 private:
  // With its cavity: the wall itself, and where most directions lead through it once. A cavity with wide openings is
  // closed as a soap film would, so that filling needs no watertight surface.
  bool in_hull(dvec3 p) const { return inside_(p) || enclosed_share(p) > 0.5; }
  double enclosed_share(dvec3 p) const;
  bool behind_sheet(dvec3 p) const;

  enum class How : std::uint8_t {
    kEnclosed,  // what the surface encloses
    kHull,      // ... and the cavity of its wall
    kLayer,     // of that, what is within `thickness` of the surface
    kSheet,     // what is within `thickness` behind an open sheet
  };
  const Mesh& surface_;
  const Inside& inside_;
  How how_ = How::kEnclosed;
  bool hollow_ = false;
  double thickness_ = 0.0;  // [m]
  double thickest_ = 0.0;   // [m] that still counts as a wall
};

}  // namespace pliant
