// A contact problem being solved: its impulses and velocities, block Gauss-Seidel sweeps over its contacts, and its
// residual. Vectors of a contact are in its axes: normal, two tangents.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/soft/contact/contact_problem.h"

namespace pliant {

class ContactSweeps {
 public:
  // One problem without parts.
  explicit ContactSweeps(ContactProblem& problem);

  // The guess may come from another problem: infeasible parts are dropped. Then u = W lambda + bias.
  void start();
  // u = W lambda + bias, for the current lambda.
  void refresh_velocity();
  // Projects every impulse into its cone.
  void project();
  void sweep();
  void finish();            // problem().velocity has the lever's part
  double residual() const;  // [m/s] SweepReport::residual
  // [m/s] Over contacts that close without impulses: distant contacts must not affect the accuracy of the others.
  double fastest() const;

  // Contacts at the border of the static cone that slip switch to the sliding coefficient. Only with converged
  // impulses: before, every contact with a small normal impulse seems to slip. Returns the number of changes.
  int begin_slips(double slowest);
  // Slipping contacts that are now inside the sliding cone stick again.
  void end_slips();

  ContactProblem& problem() { return p_; }
  double mu(int i) const { return p_.sliding[i] ? p_.mu_sliding[i] : p_.mu_static[i]; }
  // Bits of the axes along which it is a joint; 0: a contact.
  std::uint8_t held(int i) const { return p_.held.empty() ? 0 : p_.held[i]; }
  bool holds(int i, int axis) const { return (held(i) >> axis & 1) != 0; }
  // [N s] of its impulse along the first axis.
  double most(int i) const { return p_.most.empty() ? HUGE_VAL : p_.most[i]; }
  // The impulse within that bound nearest to `l`.
  double bounded(int i, double l) const { return std::clamp(l, -most(i), most(i)); }
  // A bounded joint that would push beyond its bound.
  bool at_bound(int i, double l, double u) const {
    const double w = block(i)[0][0];
    return most(i) < HUGE_VAL && std::abs(w * l - u) >= w * most(i);
  }
  bool movable(int i) const { return p_.blocks[i][0][0] > 0.0; }
  const dmat3& block(int i) const { return p_.blocks[i]; }
  dvec3 impulse(int i) const { return to_own(i, &p_.impulse[3 * i]); }
  dvec3 velocity(int i) const {
    const double* at = &p_.velocity[3 * i];
    dvec3 u;
    if (lever_) u = levered(i), at = &u.x;
    return to_own(i, at);
  }
  void set_impulse(int i, dvec3 own) {
    const dvec3 l = from_own(i, own);
    for (int k = 0; k < 3; ++k) p_.impulse[3 * i + k] = l[k];
  }
  dvec3 to_own(int i, const double* v) const {
    const dvec3 x(v[0], v[1], v[2]);
    return turned_ ? x * p_.own[i] : x;
  }
  dvec3 from_own(int i, dvec3 v) const { return turned_ ? p_.own[i] * v : v; }
  // out += change of every contact's velocity by `impulse`, in W's axes, of contact i; without the lever's part.
  void add_columns(int i, dvec3 impulse, double* out) const;

 private:
  static dvec3 three(const double* v) { return {v[0], v[1], v[2]}; }
  dvec3 lever_column(int i, int c) const {
    const double* const l = lever_->data() + 18 * i + c;
    return {l[0], l[6], l[12]};
  }
  dvec3 levered(int i) const;  // velocity of contact i, in W's axes
  void add_to_lever(int i, dvec3 impulse);
  template <bool kLever>
  void relax(int i);
  dvec3 hold(int i, dvec3 c);  // impulse of a joint's point with all others fixed: u = w lambda + c
  double residual_of(int i) const;
  dmat3 read_block(int i) const;  // of W, in the contact's axes

  ContactProblem& p_;
  const Eigen::MatrixXd& W_;
  const Lever* lever_;
  std::array<double, 6> moved_{};  // lever^T lambda: its part of the velocities is added where one is read
  std::ptrdiff_t stride_;
  bool turned_;  // contacts have axes different from W's
};

}  // namespace pliant
