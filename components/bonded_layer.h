// The stiffness of an elastic layer bonded to a rigid base under a flat punch, relative to a half-space of the same
// modulus: kappa of Hayes, Keer, Herrmann & Mockros, "A mathematical analysis for indentation tests of articular
// cartilage", J. Biomechanics 5 (1972). Small strains, no friction under the punch.
//
// Legend: a radius of the punch, h thickness, nu Poisson's ratio, F = 2 E* a kappa d. With pressures
//   A(x) = int_0^1 phi(t) cos(x t) dt,   x in 1/a,
// which vanish outside of the punch, phi solves Fredholm's equation of the second kind
//   phi(t) - int_0^1 phi(s) K(t, s) ds = 1,   K(t, s) = (2 / pi) int_0^inf (1 - L(x h / a)) cos(x t) cos(x s) dx,
//   L(z) = (2 k sinh 2z - 4 z) / (2 k cosh 2z + 1 + k^2 + 4 z^2),   k = 3 - 4 nu,   and   kappa = int_0^1 phi dt.
//
// The displacement of the surface beside the punch, relative to d, r in a (the Hankel transform of the same pressures,
// its half-space part in closed form; 1 under the punch):
//   u(r) = (2 / pi) (int_0^(asin 1/r) phi(r sin s) ds - int_0^inf (1 - L(x h / a)) A(x) J0(x r) dx).
//
// A paraboloid r^2 / 2R (a sphere near its pole) on the same layer: phi = d phi_1 - (a^2 / R) phi_2 for the right sides
// 1 and t^2, and the pressure ends with the contact, phi(1) = 0 (Lebedev & Ufliand, PMM 22, 1958).
#pragma once

#include <vector>

namespace pliant {

// a / h from 0 (half-space: kappa 1) up to this; thinner layers are solved as if they had it. nu from 0 to 0.5.
inline constexpr double kThinnest = 60.0;

// Gauss-Legendre rule on [0, 1].
struct GaussRule {
  std::vector<double> at, weight;
};
GaussRule gauss_rule(int points);

// [1] 1 - L(z): from z = 24 on below rounding.
double missing_of_layer(double z, double poisson);

class BondedLayer {
 public:
  BondedLayer(double radius_over_thickness, double poisson);
  double factor() const { return factor_; }  // [1] kappa
  double surface(double radii) const;        // [1] u at this distance from the axis, in radii of the punch

 private:
  std::vector<double> at_, weight_;  // x, and 2 / pi (1 - L) A(x) dx; empty for a half-space
  double factor_ = 1.0;
};

// Of a sphere whose contact has this radius over thickness: d R / h^2, F R / (E* h^3), and kappa of that contact, by
// which dF = 2 E* a kappa dd.
struct LayerPress {
  double depth, force, factor;
};
LayerPress sphere_on_layer(double radius_over_thickness, double poisson);

// [1] kappa for any a / h. Above kThin from the equation of thin layers: the pressure p under the punch obeys
//   p - l^2 (p'' + p'/r) = M d / h,   p(a) = 0,   M = 2 G (1 - nu) / (1 - 2 nu),   l^2 = M h^2 / (3 G),
// with the rim's correction, O(h / a), of the solution at kThin.
inline constexpr double kThin = 20.0;
double bonded_layer_factor(double radius_over_thickness, double poisson);

}  // namespace pliant
