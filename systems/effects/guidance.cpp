// A virtual fixture: a well (effect_law.h) around the foot on a path, free along it. Beyond the range the path lets go.
//
// Between two arms, and at the inside of a corner, the nearest point jumps, and the gradient with it. So the foot stays
// on its arm, and where another place is nearer the energy goes over to that one's within kOver: U = (1 - w) U1 + w U2.
// w rises while U2 < U1 and falls while U2 > U1, so that U only falls by it: energy is lost there, never made. A foot
// whose minimum ends slides downhill at a limited speed.
#include <algorithm>

#include "systems/effects/effect_law.h"
#include "systems/effects/guide_path.h"

namespace pliant {
namespace {

constexpr double kFaster = 4.0, kSlides = 0.05;  // a foot's speed: [1] of the tip's, and [m/s] beside it
constexpr double kOver = 0.04;                   // [s]
constexpr double kNearer = 0.02;                 // [1] of the range: another place is nearer by more than that

// Slides the foot and gives its well.
EffectValue follow(const EffectInput& in, PathFoot& foot) {
  const bool resting = in.path->slide(in.x, kFaster * length(in.x - in.before) + kSlides * in.dt, foot);
  const dvec3 t = in.path->direction(foot);
  const bool free = resting && !in.path->at_corner(foot);
  return well(in.effect, in.x - in.path->place(foot), free ? dmat3(1.0) - glm::outerProduct(t, t) : dmat3(1.0));
}

EffectValue mixed(const EffectValue& a, const EffectValue& b, double w) {
  EffectValue out;
  out.energy = (1.0 - w) * a.energy + w * b.energy;
  out.force = (1.0 - w) * a.force + w * b.force;
  out.stiffness = (1.0 - w) * a.stiffness + w * b.stiffness;
  return out;
}

}  // namespace

EffectValue effect_guidance(const EffectInput& in, EffectMemory& memory) {
  const double range = in.effect.range;
  if (!in.path) return {};
  if (!memory.guided) {
    memory.over = 0.0;
    memory.guided = in.path->find(in.x, range, memory.foot);
  }
  if (!memory.guided) return well(in.effect, dvec3(range, 0, 0), dmat3(1.0));
  const EffectValue first = follow(in, memory.foot);
  const double away = length(in.x - in.path->place(memory.foot));
  if (memory.over == 0.0 && !in.path->find(in.x, std::min(away, range) - kNearer * range, memory.other)) {
    memory.guided = away < range;
    return first;
  }
  const EffectValue second = follow(in, memory.other);
  memory.over += (second.energy < first.energy ? 1.0 : -1.0) * in.dt / kOver;
  if (memory.over < 1.0) {
    memory.over = std::max(0.0, memory.over);
    return mixed(first, second, memory.over);
  }
  memory.over = 0.0;
  memory.foot = memory.other;
  return second;
}

}  // namespace pliant
