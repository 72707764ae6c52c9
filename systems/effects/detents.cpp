// Detents with the largest force P between them.
// Along y, spacing s:   U = P s / (2 pi) (1 - cos(2 pi y / s)) w(x)
// Around y, N a turn:   U = P rho(r) / N (1 - cos(N theta)) w(x), rho = sqrt(r^2 + a^2) - a, a = the edge; theta from z
//                       to x. Its tangential force is P rho / r sin(N theta): P, fading within a of the axis.
#include <cmath>
#include <numbers>

#include "systems/effects/effect_law.h"

namespace pliant {
namespace {

EffectValue detents_along(const Effect& effect, dvec3 x) {
  const double wave = 2.0 * std::numbers::pi / effect.spacing, phase = wave * x.y, half = std::sin(0.5 * phase);
  EffectValue out;
  out.energy = effect.peak / wave * 2.0 * half * half;
  out.force.y = -effect.peak * std::sin(phase);
  out.stiffness[1][1] = effect.peak * wave * std::cos(phase);
  return out;
}

EffectValue detents_around(const Effect& effect, dvec3 x) {
  const double r = std::hypot(x.x, x.z), a = effect.edge, n = effect.count;
  EffectValue out;
  if (!(r > 1e-9 * a)) return out;
  const double phase = n * std::atan2(x.x, x.z), half = std::sin(0.5 * phase), c = effect.peak / n;
  const double wave = 2.0 * half * half, wave1 = n * std::sin(phase), wave2 = n * n * std::cos(phase);
  const double root = std::sqrt(r * r + a * a);
  const double rho = r * r / (root + a), rho1 = r / root, rho2 = a * a / (root * root * root);
  const dvec3 out_of(x.x / r, 0, x.z / r), around(out_of.z, 0, -out_of.x);
  const double mixed = c * wave1 * (rho1 / r - rho / (r * r));
  out.energy = c * rho * wave;
  out.force = -c * (rho1 * wave * out_of + rho / r * wave1 * around);
  out.stiffness = c * rho2 * wave * glm::outerProduct(out_of, out_of) +
                  c * (rho1 / r * wave + rho / (r * r) * wave2) * glm::outerProduct(around, around) +
                  mixed * (glm::outerProduct(out_of, around) + glm::outerProduct(around, out_of));
  return out;
}

}  // namespace

EffectValue effect_detents(const EffectInput& in, EffectMemory&) {
  const Effect& effect = in.effect;
  const EffectValue plain =
      effect.detents == DetentAxis::kAlong ? detents_along(effect, in.x) : detents_around(effect, in.x);
  return weighted(plain, region_weight(effect, in.x));
}

}  // namespace pliant
