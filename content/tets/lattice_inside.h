// Whether a point lies inside a surface, holes or not: the generalised winding number (Jacobson, Kavan,
// Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding numbers", 2013), far clusters of
// triangles taken as dipoles (Barill, Dickson, Schmidt, Levin, Jacobson, "Fast winding numbers for soups and clouds",
// 2018).
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
  // A surface turned inside out holds what it encloses all the same.
  bool operator()(dvec3 p) const { return std::abs(winding(p)) > 0.5; }
  // Whether all of a box is inside, or all outside: the surface is closed, and no triangle's box meets this one.
  bool is_uniform(dvec3 low, dvec3 high) const;
  // Where one leaves between a point inside and one outside: share [1] of the way. A triangle's plane, or where the way
  // leads through a hole, the place where the winding number passes 0.5.
  double crossing(dvec3 inside, dvec3 outside) const;

 private:
  struct Cluster {
    dvec3 centre;   // [m] of area
    dvec3 area;     // [m2] sum of area times normal
    double reach2;  // [m2] squared distance beyond which the dipole stands for the cluster
  };
  double solid_angle(std::uint32_t triangle, dvec3 p) const;

  const Mesh& surface_;
  std::vector<std::vector<Cluster>> levels_;  // as Mesh::tree's
  bool closed_ = false;                       // every edge has a triangle on either side
};

}  // namespace pliant
