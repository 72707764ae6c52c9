// A contact problem under way: its impulses and the velocities that belong to them, block Gauss-Seidel sweeps over its
// contacts, and how far it is from the contact laws. Vectors of a contact come in its own axes: normal, two tangents.
#pragma once

#include "systems/soft/contact/contact_problem.h"

namespace pliant {

class ContactSweeps {
 public:
  // One problem without parts.
  explicit ContactSweeps(ContactProblem& problem);

  // A guess may come from another problem: whatever cannot be is dropped. Then u = W lambda + bias.
  void start();
  // u = W lambda + bias, of whatever lambda is.
  void refresh_velocity();
  // Every impulse into its cone.
  void project();
  void sweep() {
    for (int i = 0; i < p_.count; ++i) relax(i);
  }
  double residual() const;  // [m/s] SweepReport::residual
  // [m/s] Of the contacts that close without impulses: what is still far away does not say how exact the others must
  // be.
  double fastest() const;

  // Contacts that have come to the border of the static cone and slip go on with the sliding coefficient. Decided only
  // on settled impulses: on the way there every contact with a small normal impulse seems to slip. How many changed?
  int begin_slips(double slowest);
  // Those that slipped and now lie inside the sliding cone hold again.
  void end_slips();

  ContactProblem& problem() { return p_; }
  double mu(int i) const { return p_.sliding[i] ? p_.mu_sliding[i] : p_.mu_static[i]; }
  bool movable(int i) const { return p_.blocks[i][0][0] > 0.0; }
  const dmat3& block(int i) const { return p_.blocks[i]; }
  dvec3 impulse(int i) const { return to_own(i, &p_.impulse[3 * i]); }
  dvec3 velocity(int i) const { return to_own(i, &p_.velocity[3 * i]); }
  void set_impulse(int i, dvec3 own) {
    const dvec3 l = from_own(i, own);
    for (int k = 0; k < 3; ++k) p_.impulse[3 * i + k] = l[k];
  }
  dvec3 to_own(int i, const double* v) const {
    const dvec3 x(v[0], v[1], v[2]);
    return turned_ ? x * p_.own[i] : x;
  }
  dvec3 from_own(int i, dvec3 v) const { return turned_ ? p_.own[i] * v : v; }
  // out += what `impulse`, in W's axes, of contact i does to every contact's velocity.
  void add_columns(int i, dvec3 impulse, double* out) const;

 private:
  void relax(int i);
  double residual_of(int i) const;
  dmat3 read_block(int i) const;  // W's, in its own axes

  ContactProblem& p_;
  std::ptrdiff_t stride_;
  bool turned_;  // contacts have axes of their own
};

}  // namespace pliant
