// Hertz' law in the local part of a split contact (methods.md 2.10). Alone on a half-space a sphere of radius R_s sinks
// in by D(F) = (16/9 E*^2 R_s)^(-1/3) F^(2/3), a^3 = 3 F R_s / (4 E*), dD/dF = 1 / (2 E* a). The lattice has a share of
// it:
//   delta(F) = D(F) - k F / (2 E* R),
// concave while a < R / k. Beyond (a = 0.98 R / k, or the radius of its pair terms) its slope stays. On a bonded layer
// dD/dF = 1 / (2 E* a kappa(a / H)).
#pragma once

#include "systems/soft/local/smeared_load.h"

namespace pliant {

inline constexpr double kWidestTip = 0.98;  // [1] of R / k

double hertz_radius(double force, double tip_radius, double reduced);  // [m] a

// A law's displacement and slope at a force [N].
struct TipState {
  double depth = 0.0;   // [m] delta
  double slope = 0.0;   // [m/N] delta'
  double radius = 0.0;  // [m] a, at most that from which the slope stays
};
TipState tip_law(const SmearedLoad& tip, double force, const LocalElasticity& tissue, const LayerKernel& layer);

// [m/N] A contact's own part of L, in the frame of its place, a tip's slope at its tip_force; and that of two contacts.
Block self_compliance(const SmearedLoad& load, const LocalElasticity& tissue, const LayerKernel& layer);
Block pair_compliance(const SmearedLoad& i, const SmearedLoad& j, const LocalElasticity& tissue,
                      const LayerKernel& layer);
// [m] Of the law's tangent at tip_force, at no force; of a point zero.
double tip_offset(const SmearedLoad& load, const LocalElasticity& tissue, const LayerKernel& layer);

// Cuts off negative eigenvalues, if there are any: loads of different radii are not positive for every arrangement.
void make_positive(Eigen::MatrixXd& compliance);

// [N] > 0: the root of delta(F) + compliance F = depth, for depth > 0 and compliance >= 0.
double tip_force(const SmearedLoad& tip, double compliance, double depth, const LocalElasticity& tissue,
                 const LayerKernel& layer);

}  // namespace pliant
