// What a pressed surface should look like: an elastic half-space under a flat punch or, with `young` and `thickness`, a
// layer bonded to something rigid (Hayes et al. 1972). Of the level and the object's size alone, so that it does not
// depend on what is chosen.
#pragma once

#include <string>
#include <vector>

#include "content/level/level.h"

namespace pliant {

// The indenter that an object is pressed with, as wide as the level says: `contact_radius`; a fifth of `reach`; the
// least radius of a spherical probe that meets surfaces; with `young` of a surface the 4 mm that it assumes; else a
// fifth of the usual reach. What no key of the object says is kept within 0.4 to 5 % of its diagonal [m], so that a
// press has room and meets several vertices.
struct UsualPunch {
  double radius = 0.0;  // [m]
  std::string why;      // "a fifth of `reach`"
};
UsualPunch usual_punch(const Level& level, std::size_t node, double diagonal);

class SurfaceTruth {
 public:
  // `diagonal` [m] of the object: its punch is the usual one.
  SurfaceTruth(const Level& level, std::size_t node, double diagonal);

  double radius() const { return radius_; }      // [m] of the punch
  double region() const { return 5 * radius_; }  // [m] from its axis, within which surfaces are compared
  double share(double r) const;                  // [1] of the depth, at a distance [m] along the surface
  std::string words() const;  // "a half-space under a flat punch of 4 mm radius (as `young` assumes)"

 private:
  double radius_ = 0.0;
  std::string why_;
  std::vector<double> layer_;  // [1] share by the root of the distance beside the punch; none: a half-space
};

// [m] The least radius of a probe that meets surfaces; 0: none is a sphere.
double least_sphere(const Level& level);

// The half-space's surface under a flat punch of this radius [m]: the share of the depth at distance r [m].
double punch_share(double r, double radius);

}  // namespace pliant
