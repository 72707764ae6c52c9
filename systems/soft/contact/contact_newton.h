// Newton steps of a contact problem on the contacts that push. Sweeps find out which contacts push and which slide;
// what they are slow at is the linear system that is left then: of holding contacts u = 0, of sliding ones u_n = 0 and
// lambda_t = mu lambda_n z / |z|, z = w lambda_t - u_t (Alart and Curnier, Computer Methods in Applied Mechanics and
// Engineering 92, 1991, linearised for the sliding direction, too). So the two take turns, as in Morales, Nocedal and
// Smelyanskiy (Numerische Mathematik 111, 2008) for contacts without friction.
//
// Where contacts say the same thing twice, the matrix is singular and a step may lead far. Its diagonal is enlarged
// (Levenberg), the more the oftener steps have failed; contacts that the step would make pull are left out, those that
// it meets first before the others, and the step is found anew. A step counts only if the residual falls.
//
// Tried on contact problems of the level hand_crowd at 1/60 s: 200 sweeps end above 1e-6 in 35 of 38, Anderson's
// extrapolation (5, 10 or 20 sweeps, at most 400) in 16, 14 and 10 of 38 and takes two to four times as long; Newton
// steps with Alart and Curnier's active set in place of the sweeps' run away on redundant contacts. ADMM
// (contact_admm.h) settles walls, but takes thousands of iterations for columns that a few Newton steps settle.
#pragma once

#include "systems/soft/contact/contact_sweeps.h"

namespace pliant {

class ContactNewton {
 public:
  // `most`: systems that may be solved.
  ContactNewton(ContactSweeps& sweeps, int most);

  // After so many sweeps in a row since the last step.
  bool due(int sweeps) const { return solves_ < most_ && sweeps >= wait_; }
  // From impulses and velocities with `residual` [m/s] to better ones, or back to the same ones. Returns their
  // residual; below `enough`, it need not fall further.
  double step(double residual, double enough);
  int solves() const { return solves_; }

 private:
  bool find_step();        // into base: the impulses that it leads to. False: there is none
  bool choose_unknowns();  // the linear system's, of the contacts that push and are not dropped
  void fill_system();
  bool solve_system();
  bool drop_pulling();           // of the contacts that the solution would make pull, those that it meets first
  double first_pull() const;     // [1] of the step: where the first contact ceases to push
  double attempt(double share);  // go `share` of the step, and the residual there

  ContactSweeps& s_;
  NewtonMemory& m_;
  int most_, solves_ = 0, wait_, unknowns_ = 0;
  double damping_;     // [1] of the diagonal
  double work_ = 0.0;  // [1] multiplications in the systems that were solved
};

}  // namespace pliant
