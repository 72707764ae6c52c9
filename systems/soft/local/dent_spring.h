// The law of split contacts on tissue whose node has PLIANT_deformable (methods.md 2.10): P1's force f of the depth
// delta of the dent alone, in series with the lattice under the smeared force. In a step of T [s] with E = e^(-T/tau),
//   F(delta) = f + r1 E (f - z0) + c (delta - delta0) / T,   z1 = z0 + (1 - E) (f - z0),
// z the relaxed force of its arm (Fung), c contact_damping; z and delta0 of the last step, of probes alone. Contacts
// share dents as probes do (methods.md 1.10): L_ij = phi(s_ij) sqrt(c_i c_j), c = d delta / dF.
#pragma once

#include "systems/touch/model/contact_energy.h"
#include "systems/touch/model/contact_law.h"

namespace pliant {

// Of one body, which outlives its contacts.
struct DentSpring {
  DentSpring(const Deformable& deformable, double step);
  DentSpring(const DentSpring&) = delete;
  DentSpring& operator=(const DentSpring&) = delete;

  Deformable deformable;
  Motion motion;
  ShareKernel shared;    // phi
  double damping = 0.0;  // [N s/m] c, unpainted
  // Beyond its last row a table stays constant on a surface, whose depth is given. In series with the lattice the depth
  // follows from the force: it hardens by 0.1 % of the table's mean slope.
  double last = 0.0, hardening = 0.0;  // [m] depth of the last row; [N/m]; 0: no table
};

// The painted factor below which nothing is softer. [1]
inline constexpr double kLeastPaint = 0.01;

// At one contact, in one step.
struct DentSpringAt {
  const DentSpring* of = nullptr;
  double paint = 1.0;    // [1] factor on the stiffness, and of its arm
  double radius = 0.0;   // [m] of the probe's tip; 0: a point of a mesh
  double step = 0.0;     // [s] T; 0: without relaxation and damping
  double dented = 0.0;   // [m] delta0
  double relaxed = 0.0;  // [N] z0

  double force(double depth) const;          // [N] F
  double slope(double depth) const;          // [N/m] dF/d delta > 0
  double depth(double force) const;          // [m] the inverse of F
  double first_compliance() const;           // [m/N] at small depth, of a tip of no radius
  double secant_compliance() const;          // [m/N] at delta0
  double relaxed_after(double depth) const;  // [N] z1

 private:
  ContactLaw law() const;
  double decay() const;  // [1] E
  double share() const;  // [1] r1
};

}  // namespace pliant
