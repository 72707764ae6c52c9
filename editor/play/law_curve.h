// The law that a level's author gave a surface, as force against depth: what a probe would feel that presses slowly on
// an unpainted place at rest (methods.md 1.8).
#pragma once

#include <vector>

#include "components/deformable.h"
#include "components/math.h"

namespace pliant {

struct LawCurve {
  std::vector<dvec2> slow;  // [m], [N]
  std::vector<dvec2> fast;  // the same of a press that leaves no time to relax; empty: no other
};
// `radius` [m] of the probe, `rate` [Hz] of the touch clock, `deepest` [m].
LawCurve law_curve(const Deformable& surface, double radius, double rate, double deepest, std::size_t points = 64);

}  // namespace pliant
