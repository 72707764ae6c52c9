// Reference surface of a press: an elastic half-space under a flat punch or, with `young` and `thickness`, a layer
// bonded to a rigid base (Hayes et al. 1972). It depends on the level and the object's size only, not on what is
// chosen.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"

namespace pliant {

// The indenter for an object. Its radius follows the level: `contact_radius`; a fifth of `reach`; the smallest radius
// of a spherical probe that meets surfaces; with `young` of a surface the 4 mm that it assumes; else a fifth of the
// usual reach. A radius not given by a key of the object is clamped to 0.4 to 5 % of its diagonal [m], so that a press
// has room and meets several vertices.
struct UsualPunch {
  double radius = 0.0;  // [m]
  std::string why;      // "a fifth of `reach`"
};
UsualPunch usual_punch(const Level& level, std::size_t node, double diagonal);

class SurfaceTruth {
 public:
  // `diagonal` [m] of the object, for the usual punch.
  SurfaceTruth(const Level& level, std::size_t node, double diagonal);

  double radius() const { return radius_; }      // [m] of the punch
  double region() const { return 5 * radius_; }  // [m] from the punch's axis, within which surfaces are compared
  double share(double r) const;                  // [1] of the depth, at a distance [m] along the surface
  std::string words() const;  // "a half-space under a flat punch of 4 mm radius (as `young` assumes)"

 private:
  double radius_ = 0.0;
  std::string why_;
  std::vector<double> layer_;  // [1] share at even steps of the root of the distance from the punch; empty: half-space
};

// [m] Smallest radius of a probe that meets surfaces; 0: none is a sphere.
double least_sphere(const Level& level);

// The surface of a half-space under a flat punch of this radius [m]: the share of the depth at distance r [m].
double punch_share(double r, double radius);

}  // namespace pliant
