// Both laws have a second minimum, at F = 0: an element whose edges all shrank to a fraction (0.54 at nu 0, 0.09 at nu
// 0.45) would stay a point. This hump removes it: mu/2 (1 - I/1.5)^3 where I < 1.5, smooth to the second derivative.
// Tissue under load does not come there: without a change of volume I is at least 3.
#pragma once

#include "systems/soft/fem/law/elastic_law.h"

namespace pliant {

inline void add_collapse_hump(double mu, double I, Density& to) {
  constexpr double kEnd = 1.5, kHeight = 0.5;
  if (!(I < kEnd)) return;
  const double left = 1.0 - I / kEnd, c = kHeight * mu;
  to.psi += c * left * left * left;
  to.I -= 3.0 * c * left * left / kEnd;
  to.II += 6.0 * c * left / (kEnd * kEnd);
}

}  // namespace pliant
