// Drag in a region: F = -b w(x) v. Its power, -b w |v|^2, is never above zero.
#include "systems/effects/effect_law.h"

namespace pliant {

EffectValue effect_viscosity(const EffectInput& in, EffectMemory&) {
  EffectValue out;
  out.damping = in.effect.damping * region_weight(in.effect, in.x).value;
  return out;
}

}  // namespace pliant
