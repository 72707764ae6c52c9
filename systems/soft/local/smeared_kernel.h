// Half-space under smeared loads, for the split of contacts on tissue (methods.md 2.10). Two Gaussian loads of standard
// deviations s_i and s_j act on each other as one of sigma^2 = (s_i^2 + s_j^2) / 2 acts on itself. At distance s,
//   h0(s) = int_0^inf J0(x s) e^(-x^2 sigma^2) dx = sqrt(pi) / (2 sigma) e^-t I0(t),   t = s^2 / (8 sigma^2),
//   h2(s) = int_0^inf J2(x s) e^(-x^2 sigma^2) dx = sqrt(pi) / (2 sigma) e^-t I1(t),
//   h1(s) = int_0^inf J1(x s) e^(-x^2 sigma^2) dx = (1 - e^(-s^2 / (4 sigma^2))) / s;
// all tend to 1 / s. The normal displacement per force is h0 / (pi E*). On a layer of thickness H bonded to a rigid
// base it is (h0 - below) / (pi E*), with 1 - L of Hayes et al. (components/bonded_layer.h),
//   below(s) = int_0^inf (1 - L(x H)) J0(x s) e^(-x^2 sigma^2) dx.
// Every radius R, that of the flat punch of the same compliance 1 / (2 E* R), belongs to a Gaussian of sigma = R /
// sqrt(pi).
#pragma once

#include <vector>

namespace pliant {

inline constexpr double kSigmaOfRadius = 0.564189583547756287;  // [1] 1 / sqrt(pi)

// [1/m] of s >= 0 and sigma > 0 [m].
double h0(double s, double sigma);
double h1(double s, double sigma);
double h2(double s, double sigma);

// `below` and Hayes' factor from tables, for one Poisson's ratio.
class LayerKernel {
 public:
  explicit LayerKernel(double poisson);
  // [1/m] within 1e-5 / H up to s = kFarthest H and sigma = kWidest H; farther and wider loads as those.
  double below(double s, double sigma, double thickness) const;
  static double by_quadrature(double s, double sigma, double thickness, double poisson);
  // [1] lambda: compliance of a Gaussian of radius R on the layer over that on a half-space.
  double share(double radius, double thickness) const;
  // [1] kappa of a punch of radius a, within 1e-4 up to a / H = 3; beyond exactly.
  double punch(double radius_over_thickness) const;

  static constexpr double kFarthest = 8.0, kWidest = 1.3;  // [1]

 private:
  double poisson_;
  std::vector<double> table_, punch_;
};

}  // namespace pliant
