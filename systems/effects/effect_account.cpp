#include "systems/effects/effect_account.h"

#include <algorithm>

#include "systems/effects/felt_effects.h"

namespace pliant {

BesideObserver effects_beside(const World& world, Entity probe, double share) {
  constexpr double kSpent = 0.1;  // [1] of the energy: with less in the reserve, the force goes to the observer
  const FeltEffects* const felt = world.registry.find<FeltEffects>(probe);
  if (!felt) return {};
  const double needed = kSpent * felt->let_in * felt->energy;
  const double covered = needed > 0.0 ? std::min(1.0, felt->reserve / needed) : 1.0;
  return {share * covered * felt->force, share * covered * felt->torque};
}

void keep_account(World& world, Entity probe, const SafetyState& safety, double share, dvec3 unfelt) {
  FeltEffects* const felt = world.registry.find<FeltEffects>(probe);
  if (!felt) return;
  const double size2 = dot(felt->force, felt->force);
  const double let_in = safety.engaged ? 1.0 - safety.hidden : 0.0;
  const double sent = size2 > 0.0 ? std::clamp(dot(safety.weight, felt->force) / size2, 0.0, 1.0) : share * let_in;
  if (!safety.engaged) felt->reserve = 0.0;
  felt->reserve +=
      0.5 * (sent + felt->sent) * (felt->energy - felt->before + 0.5 * dot(felt->torque + felt->last_torque, unfelt));
  felt->reserve += std::max(0.0, let_in - felt->let_in) * felt->energy;
  felt->reserve = std::clamp(felt->reserve, 0.0, felt->energy);
  felt->last_torque = felt->torque;
  felt->sent = sent;
  felt->let_in = let_in;
}

}  // namespace pliant
