// Stable Neo-Hookean: Smith, de Goes, Kim, "Stable Neo-Hookean Flesh Simulation", ACM Transactions on Graphics 37
// (2018), eq. (9) without the logarithm, with the moduli of section 3.4:
//   psi = mu/2 (I - 3) + l/2 (J - a)^2 - mu^2/2l,   l = lambda + mu,   a = 1 + mu/l.
// With the logarithm it would be 16 % too stiff at 70 % squash against the incompressible Neo-Hookean law.
#pragma once

#include "systems/soft/fem/law/collapse.h"

namespace pliant {

inline Density neo_hookean(const LawConstants& material, double I, double J) {
  const double mu = material.mu, l = material.lambda + mu;
  Density out;
  out.psi = 0.5 * mu * (I - 3.0 - 2.0 * (J - 1.0)) + 0.5 * l * (J - 1.0) * (J - 1.0);  // the same, without cancellation
  out.I = 0.5 * mu;
  out.J = l * (J - 1.0) - mu;
  out.JJ = l;
  add_collapse_hump(mu, I, out);
  return out;
}

}  // namespace pliant
