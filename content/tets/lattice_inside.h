// Whether a point lies inside a surface that may have holes. Uses the generalised winding number (Jacobson, Kavan,
// Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding numbers", 2013); distant triangle
// clusters are dipoles (Barill, Dickson, Schmidt, Levin, Jacobson, "Fast winding numbers for soups and clouds", 2018).
#pragma once

#include <vector>

#include "components/mesh.h"

namespace pliant {

class Inside {
 public:
  explicit Inside(const Mesh& surface);  // keeps a reference

  // [1] 1 inside a closed surface that faces outward, 0 outside; in between near holes.
  double winding(dvec3 p) const;
  double winding_by_sum(dvec3 p) const;  // exact, over every triangle; for tests
  // Also true inside a surface that is inside out.
  bool operator()(dvec3 p) const { return std::abs(winding(p)) > 0.5; }
  // Whether a box is entirely inside or entirely outside: the surface is closed and no triangle's box meets it.
  bool is_uniform(dvec3 low, dvec3 high) const;
  // The boundary crossing between a point inside and one outside: share [1] of the way. This is a triangle's plane, or
  // in a hole the point where the winding number passes 0.5.
  double crossing(dvec3 inside, dvec3 outside) const;

 private:
  struct Cluster {
    dvec3 centre;   // [m] of area
    dvec3 area;     // [m2] sum of area times normal
    double reach2;  // [m2] squared distance beyond which the dipole is used
  };
  double solid_angle(std::uint32_t triangle, dvec3 p) const;

  const Mesh& surface_;
  std::vector<std::vector<Cluster>> levels_;  // parallel to Mesh::tree
  bool closed_ = false;                       // every edge has a triangle on both sides
};

}  // namespace pliant
