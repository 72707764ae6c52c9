// The force of a frictionless rigid sphere on an elastic layer that is bonded to something rigid, small strains; a half
// space where it is deep (Hertz).
//
// A sphere's contact grows over circles of radius a. Each step of it is the step of a flat punch of that radius (true
// of every layered half-space: Mossakovskii; Barber, Contact Mechanics, 2018), so with u(r; a) and kappa(a) of
// bonded_layer.h and R the sphere's radius
//   r^2 / 2R = int_0^r (1 - u(r; a)) d'(a) da   gives d'(a), the depth's growth,   F = 2 E* int_0^c a kappa(a) d'(a)
//   da.
#pragma once

#include <vector>

namespace pliant {

class LayerSphere {
 public:
  // radius, thickness (0: half-space) and the largest depth needed [m].
  LayerSphere(double radius, double thickness, double poisson, double deepest);
  // [m2] at a depth [m] from 0 to `deepest`; times E* it is the force.
  double force(double depth) const;

 private:
  double radius_;
  std::vector<double> depth_, over_hertz_;  // [m]; [1] F over Hertz's; empty for a half-space
};

}  // namespace pliant
