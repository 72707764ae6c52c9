// A second-order step of tissue: two implicit Euler stages of h = gamma T, gamma = 1 - 1/sqrt(2), with one matrix
// A = M + h D + h^2 K' (an L-stable and algebraically stable SDIRK method: Pareschi and Russo 2005, "SSP2(2,2,2)"):
//   A V1 = M v0 + h f(x0) + gamma L1,
//   A V2 = M (v0 + sqrt2 (V1 - v0)) + h f(x0 + sqrt2 h V1) + h sqrt2 r + gamma L2,
//   x1 = x0 + T w,   w = (V1 + V2) / 2,   v1 = (2 + sqrt2) w - (1 + sqrt2) V1,   impulse of the step (L1 + L2) / 2.
// r: the difference of f(x0 + sqrt2 h V1) from its linearisation at x0. K' lacks the derivative of rotations; without r
// the step would be of first order wherever stressed tissue turns (a W-method: Steihaug and Wolfbrandt 1979).
//
// Contacts: one problem for (V1, L1) as if the force lasted all the step, then one for the step's mean w and impulse L,
// each with the operator J (A / gamma)^-1 J^T and the same gaps: g + T V1 >= 0, then g + T w >= 0. Both satisfy the
// same monotone law, so the work L w + (L1 - L)(V1 - w) is never positive: contact and friction make no energy, also
// with bodies that step otherwise, for which the first problem is a trial. A node that arrives has V1 = w = 0, so v1 =
// 0: it does not rebound, as it would with the midpoint rule and with BDF2. Compared in the study `time_step`.
#pragma once

#include <limits>
#include <vector>

#include "systems/soft/body/schur.h"
#include "systems/soft/fem/tissue.h"

namespace pliant {

class TwoStages {
 public:
  static constexpr double kShare = 0.29289321881345247560;  // [1] gamma

  // `even_damping`: the factor on Rayleigh's beta is 1 everywhere. Without it r counts once only.
  explicit TwoStages(bool even_damping) : even_damping_(even_damping) {}

  // After tissue.assemble(kShare * T, gravity) and its factorisation. `V1`: the first stage without loads or contacts.
  void begin(const Tissue& tissue, double T, dvec3 gravity, const Vector& V1);
  // V1 with loads, without contacts: what it is at the first call of a step.
  void restart(Vector& V1);
  // From V1 with its contacts to w without any.
  void turn(Tissue& tissue, const CoupledSolver& solver, Vector& V1_to_w);

  Vector ending(const Vector& w) const;     // v1 [m/s]
  Vector force_lag(const Vector& w) const;  // Body::force_lag
  struct End {
    Vector motion, velocity;  // [m/s] w, v1
    bool shortened = false;   // motion: the tissue is out of its linearisation's range
  };
  // The end of a step of `share` T. Elastic and kinetic energy rise by no more than the work of the step's impulses: v1
  // is smaller then. `free`: no node is fixed; momentum is kept, and angular momentum about the centre of mass.
  End finish(const Tissue& tissue, const Vector& w, double share, bool free);

 private:
  Vector impulses(const Tissue& tissue, const Vector& w) const;  // [N s] besides elastic forces and damping, per node

  bool even_damping_;
  double T_ = 0.0, h_ = 0.0;  // [s]
  dvec3 gravity_{0};
  bool begun_ = false;
  Vector alone_, loaded_;  // [m/s] V1 without loads and contacts; without contacts
  Vector begin_force_;     // [N] f(x0)
  Vector first_;           // [m/s] V1
  Vector free_mean_;       // [m/s] w without contacts
  Vector loads_;           // [N s] h-fold, of loads: A (loaded - alone)
  // [J] Energy that earlier steps lost, up to a hundredth: truncation errors have both signs. At first all of that.
  double credit_ = std::numeric_limits<double>::infinity();
};

}  // namespace pliant
