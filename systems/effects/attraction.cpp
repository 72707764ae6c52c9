// A magnet: a well (effect_law.h) around a point, a segment or a plane. These are convex, so that the nearest point is
// one, and the distance squared is smooth.
#include <algorithm>

#include "systems/effects/effect_law.h"

namespace pliant {

EffectValue effect_attraction(const EffectInput& in, EffectMemory&) {
  const Effect& effect = in.effect;
  dvec3 v = in.x;
  dmat3 moves(1.0);
  // Along this axis the target reaches from `low` to `high`.
  const auto reach = [&](int axis, double low, double high) {
    const double x = in.x[axis];
    v[axis] = x - std::clamp(x, low, high);
    if (x > low && x < high) moves[axis][axis] = 0.0;
  };
  if (effect.target == EffectTarget::kSegment) reach(1, 0.0, effect.length);
  if (effect.target == EffectTarget::kPlane)
    for (const int side : {0, 1}) {
      const double size = effect.size[static_cast<std::size_t>(side)], half = size > 0.0 ? 0.5 * size : 1e9;
      reach(2 * side, -half, half);
    }
  return well(effect, v, moves);
}

}  // namespace pliant
