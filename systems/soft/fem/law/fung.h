// Exponential law (Fung 1967; Demiray, Journal of Biomechanics 5 (1972), for isotropic tissue), with the volumetric
// part of neo_hookean.h:
//   psi = mu/2b (exp(b Q) - 1) + l/2 (J - 1)^2,   Q = I - 3 - 2 (J - 1),   l = lambda + mu.
// Q is the Neo-Hookean energy in units of mu/2: b = 0 is that law. Without a change of volume Q = I - 3. Beyond b Q =
// 20 (inverted elements) the exponential goes on as its parabola.
#pragma once

#include <cmath>

#include "systems/soft/fem/law/collapse.h"

namespace pliant {

inline Density fung(const LawConstants& material, double I, double J) {
  constexpr double kLargest = 20.0;
  const double mu = material.mu, l = material.lambda + mu, b = material.b, q = I - 3.0 - 2.0 * (J - 1.0);
  // g(q) = (e^(bq) - 1) / b and its derivatives.
  const double e = std::exp(b < 1e-9 ? 0.0 : std::fmin(b * q, kLargest));
  const double over = std::fmax(b * q - kLargest, 0.0);
  const double g = b < 1e-9 ? q : (std::expm1(std::fmin(b * q, kLargest)) + e * over * (1.0 + 0.5 * over)) / b;
  const double slope = e * (1.0 + over), bend = b * e;
  Density out;
  out.psi = 0.5 * mu * g + 0.5 * l * (J - 1.0) * (J - 1.0);
  out.I = 0.5 * mu * slope;
  out.J = -mu * slope + l * (J - 1.0);
  out.II = 0.5 * mu * bend;
  out.IJ = -mu * bend;
  out.JJ = 2.0 * mu * bend + l;
  add_collapse_hump(mu, I, out);
  return out;
}

}  // namespace pliant
