// A surface's authored law as force against depth: the force on a probe that presses slowly on an unpainted point at
// rest (methods.md 1.8).
#pragma once

#include <vector>

#include "components/deformable.h"
#include "components/math.h"

namespace pliant {

struct LawCurve {
  std::vector<dvec2> slow;  // [m], [N]
  std::vector<dvec2> fast;  // the same for a press too fast for relaxation; empty: identical
};
// `radius` [m] of the probe, `rate` [Hz] of the touch clock, `deepest` [m].
LawCurve law_curve(const Deformable& surface, double radius, double rate, double deepest, std::size_t points = 64);

}  // namespace pliant
