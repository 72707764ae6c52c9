// A constant force G in a region: U = B - w(x) G.(x - c), c the region's middle. Inside of the edge the force is G; in
// the edge the work over the whole region is paid or given back: there it is up to |G| (1 + 1.5 d / e), for a distance
// d from c along G and an edge e. B keeps U above zero; what acts everywhere or in a half-space has it within kRoom.
#include <algorithm>

#include "systems/effects/effect_law.h"

namespace pliant {

EffectValue effect_gravity(const EffectInput& in, EffectMemory&) {
  constexpr double kRoom = 100.0;  // [m]
  const Effect& effect = in.effect;
  const dvec3 g = effect.force;
  dvec3 middle(0);
  double least = kRoom * length(g);
  if (effect.region == EffectRegion::kSphere) least = effect.radius * length(g);
  if (effect.region == EffectRegion::kBox) {
    const dvec3 low = effect.box.min, high = effect.box.max;
    middle = 0.5 * (low + high);
    least = 0.5 * dot(glm::abs(g), high - low);
  }
  EffectValue plain;
  plain.energy = -dot(g, in.x - middle);
  plain.force = g;
  EffectValue out = weighted(plain, region_weight(effect, in.x));
  out.energy = std::max(0.0, out.energy + least);
  return out;
}

}  // namespace pliant
