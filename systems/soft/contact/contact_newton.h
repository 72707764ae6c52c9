// Newton steps of a contact problem on the pushing contacts. Sweeps find out which contacts push and which slide. They
// converge slowly on the remaining linear system: sticking contacts u = 0, sliding ones u_n = 0 and lambda_t = mu
// lambda_n z / |z|, z = w lambda_t - u_t (Alart and Curnier, Computer Methods in Applied Mechanics and Engineering 92,
// 1991, also linearised for the sliding direction). So the two alternate, as in Morales, Nocedal and Smelyanskiy
// (Numerische Mathematik 111, 2008) for contacts without friction.
//
// With redundant contacts the matrix is singular and a step may be very long. Its diagonal is enlarged (Levenberg),
// more after each failed step. Contacts that the step would make pull are dropped, those that it reaches first before
// the others, and the step is recomputed. A step is accepted only if the residual falls.
//
// Measured on contact problems of the level hand_crowd at 1/60 s: 200 sweeps end above 1e-6 in 35 of 38. Anderson's
// extrapolation (5, 10 or 20 sweeps, at most 400) does in 16, 14 and 10 of 38 and takes two to four times as long.
// Newton steps with Alart and Curnier's active set instead of the sweeps' diverge on redundant contacts. ADMM
// (contact_admm.h) solves walls, but takes thousands of iterations for columns that a few Newton steps solve.
#pragma once

#include "systems/soft/contact/contact_sweeps.h"

namespace pliant {

class ContactNewton {
 public:
  // `most`: limit of the number of linear solves.
  ContactNewton(ContactSweeps& sweeps, int most);

  // True after enough successive sweeps since the last step.
  bool due(int sweeps) const { return solves_ < most_ && sweeps >= wait_; }
  // Improves impulses and velocities with `residual` [m/s], or restores them. Returns their residual; it stops below
  // `enough`.
  double step(double residual, double enough);
  int solves() const { return solves_; }

 private:
  bool find_step();        // into base: the resulting impulses. False: there is no step
  bool choose_unknowns();  // unknowns of the linear system: of pushing contacts that are not dropped
  void fill_system();
  bool solve_system();
  bool drop_pulling();           // drops contacts that the solution would make pull, those that it reaches first
  double first_pull() const;     // [1] of the step: where the first contact stops pushing
  double attempt(double share);  // takes `share` of the step; returns the residual

  ContactSweeps& s_;
  NewtonMemory& m_;
  int most_, solves_ = 0, wait_, unknowns_ = 0;
  double damping_;     // [1] of the diagonal
  double work_ = 0.0;  // [1] multiplications in the systems solved so far
};

}  // namespace pliant
