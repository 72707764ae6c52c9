// Whether a point lies inside a surface that may have holes. Uses the generalised winding number (Jacobson, Kavan,
// Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding numbers", 2013); distant triangle
// clusters are dipoles (Barill, Dickson, Schmidt, Levin, Jacobson, "Fast winding numbers for soups and clouds", 2018).
//
// The winding number of a closed surface is constant where no triangle lies in between. A grid of boxes over its bounds
// joins neighbours that hold no triangle's box, and each joined part needs one number. Points there are looked up, in a
// tenth of the time; the number is summed for points in boxes that hold triangles.
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
  bool operator()(dvec3 p) const {
    const Side side = side_of(p);
    return side == Side::kUnknown ? by_winding(p) : side == Side::kInside;
  }
  bool by_winding(dvec3 p) const { return std::abs(winding(p)) > 0.5; }  // the same without the grid
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
  enum class Side : std::uint8_t { kUnknown, kInside, kOutside, kFree };  // kFree: while the grid is made
  double solid_angle(std::uint32_t triangle, dvec3 p) const;
  bool is_closed() const;
  void make_grid();
  void join(std::uint32_t from, std::vector<std::uint32_t>& part);
  // Of a grown place: rounding is monotonic, so a point and a triangle in different boxes lie apart.
  glm::ivec3 box_of(dvec3 p) const {
    const dvec3 at = glm::floor((p - low_) * over_);
    return glm::ivec3(glm::clamp(at, dvec3(-1), dvec3(count_)));
  }
  std::uint32_t number_of(glm::ivec3 box) const {
    return static_cast<std::uint32_t>((box.z * count_.y + box.y) * count_.x + box.x);
  }
  Side side_of(dvec3 p) const {
    if (sides_.empty()) return Side::kUnknown;
    const glm::ivec3 box = box_of(p);
    if (glm::any(glm::lessThan(box, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(box, count_)))
      return Side::kOutside;
    return sides_[number_of(box)];
  }

  const Mesh& surface_;
  std::vector<std::vector<Cluster>> levels_;  // parallel to Mesh::tree
  bool closed_ = false;                       // every edge has a triangle on both sides
  std::vector<Side> sides_;                   // of the grid's boxes, x first; empty: no grid
  glm::ivec3 count_{0};
  dvec3 low_{0};   // [m]
  dvec3 over_{0};  // [1/m] inverse of a box's sides
};

}  // namespace pliant
