#include "systems/effects/effects.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "components/probe_shape.h"
#include "systems/effects/felt_effects.h"
#include "systems/touch/feed/touch_events.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

constexpr double kElsewhere = 1e-6;  // [m] a place that is farther from where motion has brought it was set anew

void begin(FeltEffects& felt) {
  felt.force = felt.drag = felt.torque = felt.drag_torque = felt.carried = dvec3(0);
  felt.stiffness = dmat3(0.0);
  felt.damping = felt.energy = felt.before = 0.0;
}

bool finite(const EffectValue& value) {
  const dvec3 f = value.force;
  return std::isfinite(value.energy) && std::isfinite(f.x + f.y + f.z) && std::isfinite(value.damping);
}

dvec3 place_before(const Probe& probe, const EffectTip& tip) {
  return probe.fresh ? probe.position + probe.rotation * tip.place
                     : probe.previous + probe.previous_rotation * tip.place;
}

void look_at_tip(World& world, const EffectPair& pair, EffectTip& tip, Tick tick) {
  const Registry& registry = world.registry;
  const Probe& probe = registry.get<Probe>(pair.probe);
  EffectMemory& memory = tip.memory;
  const Pose& pose = registry.get<Pose>(pair.effect);
  const GuidedBy* const guide = registry.find<GuidedBy>(pair.effect);
  const dvec3 at = probe.position + probe.rotation * tip.place;
  const EffectInput in{registry.get<Effect>(pair.effect),
                       guide ? &guide->path : nullptr,
                       pose.to_local(at),
                       pose_before(registry, pair.effect).to_local(place_before(probe, tip)),
                       probe.radius,
                       tick.elapsed()};
  if (probe.fresh || (memory.begun && length(in.before - memory.last) > kElsewhere)) memory = {};
  tip.value = effect_value(in, memory);
  if (!finite(tip.value)) {
    world.dropped |= kDroppedNonFinite;
    tip.value = {};
    memory = {};
  }
  tip.before = memory.begun ? memory.energy : tip.value.energy;
  memory.begun = true;
  memory.last = in.x;
  memory.energy = tip.value.energy;
}

void act_on_tip(const Registry& registry, const EffectPair& pair, const EffectTip& tip, double part, Tick tick,
                FeltEffects& felt) {
  const Probe& probe = registry.get<Probe>(pair.probe);
  const Pose& pose = registry.get<Pose>(pair.effect);
  const EffectValue& value = tip.value;
  const dvec3 at = probe.position + probe.rotation * tip.place;
  felt.energy += part * value.energy;
  const dvec3 force = part * (pose.rotation * value.force);
  felt.force += force;
  dvec3 drag(0);
  if (value.damping > 0.0) {
    const dvec3 moves = surface_velocity(registry, pair.effect, at);
    drag = -part * value.damping * ((at - place_before(probe, tip)) / tick.elapsed() - moves);
    felt.drag += drag;
    felt.damping += part * value.damping;
    felt.carried += length(drag) * moves;
  }
  felt.torque += cross(at - probe.position, force);
  felt.drag_torque += cross(at - probe.position, drag);
  const dmat3 turn = glm::mat3_cast(pose.rotation);
  felt.stiffness += part * (turn * value.stiffness * glm::transpose(turn));
}

// Each part of the probe stands for itself: of a capsule the sphere with the most energy.
void act_on_parts(const Registry& registry, const EffectPair& pair, Tick tick, FeltEffects& felt) {
  for (std::size_t first = 0; first < pair.tips.size();) {
    std::size_t best = first, next = first;
    double before = 0.0;
    for (; next < pair.tips.size() && pair.tips[next].part == pair.tips[first].part; ++next) {
      if (pair.tips[next].value.energy > pair.tips[best].value.energy) best = next;
      before = std::max(before, pair.tips[next].before);
    }
    act_on_tip(registry, pair, pair.tips[best], 1.0, tick, felt);
    felt.before += before;
    first = next;
  }
}

void act(World& world, EffectPair& pair, Tick tick, FeltEffects& felt) {
  for (EffectTip& tip : pair.tips) look_at_tip(world, pair, tip, tick);
  if (row_of(world.registry.get<Effect>(pair.effect).kind).tips == EffectTips::kParts)
    return act_on_parts(world.registry, pair, tick, felt);
  const double part = 1.0 / static_cast<double>(pair.tips.size());
  for (const EffectTip& tip : pair.tips) {
    act_on_tip(world.registry, pair, tip, part, tick, felt);
    felt.before += part * tip.before;
  }
}

// The detent nearest to a place in the effect's frame, 0 at the node; around the axis from 0 up.
std::int32_t nearest_detent(const Effect& effect, dvec3 x) {
  const auto whole = [](double value) { return static_cast<std::int32_t>(std::clamp(std::round(value), -1e9, 1e9)); };
  if (effect.detents == DetentAxis::kAlong) return whole(x.y / effect.spacing);
  const std::int32_t count = std::max(whole(effect.count), 1);
  return (whole(effect.count * std::atan2(x.x, x.z) / (2.0 * std::numbers::pi)) + count) % count;
}

// An event for every detent that the probe, the middle of its tips, goes over to.
void tell_detents(World& world, EffectPair& pair, Tick tick) {
  const Effect& effect = world.registry.get<Effect>(pair.effect);
  if (effect.kind != EffectKind::kDetents) return;
  const Probe& probe = world.registry.get<Probe>(pair.probe);
  dvec3 middle(0);
  for (const EffectTip& tip : pair.tips) middle += tip.place / static_cast<double>(pair.tips.size());
  const dvec3 at = probe.position + probe.rotation * middle;
  const dvec3 x = world.registry.get<Pose>(pair.effect).to_local(at);
  const bool rested = pair.resting && !probe.fresh;
  pair.resting = region_weight(effect, x).value > 0.0;
  const std::int32_t before = std::exchange(pair.detent, nearest_detent(effect, x));
  if (rested && pair.resting && before != pair.detent)
    add_event(*world.touch, {FeltKind::kCrossed, pair.detent, tick.index, tick.time, pair.probe, pair.effect, at, 0.0});
}

// Without its negative eigenvalues: between two ticks a force that falls with the way is kept as it is.
dmat3 positive_part(const dmat3& m) {
  if (m == dmat3(0.0)) return m;
  Eigen::Matrix3d symmetric;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) symmetric(i, j) = 0.5 * (m[i][j] + m[j][i]);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(symmetric);
  dmat3 out(0.0);
  if (solver.info() != Eigen::Success) return out;
  for (int k = 0; k < 3; ++k) {
    const double value = solver.eigenvalues()[k];
    if (!(value > 0.0)) continue;
    const dvec3 v(solver.eigenvectors()(0, k), solver.eigenvectors()(1, k), solver.eigenvectors()(2, k));
    out += value * glm::outerProduct(v, v);
  }
  return out;
}

// Of a level's `max_stiffness`: the share falls at once, and returns to 1 only where nothing is stiff, so that it stays
// passive.
void limit(FeltEffects& felt, double most) {
  const dmat3& k = felt.stiffness;
  double stiffest = 0.0;
  for (int i = 0; i < 3; ++i) stiffest = std::max(stiffest, std::abs(k[0][i]) + std::abs(k[1][i]) + std::abs(k[2][i]));
  if (!(most > 0.0) || !(stiffest > 0.0))
    felt.limited = 1.0;
  else
    felt.limited = std::min(felt.limited, most / stiffest);
  if (felt.limited == 1.0) return;
  felt.force *= felt.limited;
  felt.torque *= felt.limited;
  felt.stiffness *= felt.limited;
  felt.energy *= felt.limited;
  felt.before *= felt.limited;
}

// Spheres half a radius apart along a capsule, at most kMost.
std::vector<EffectTip> tips_of_effects(const Registry& registry, Entity entity) {
  constexpr int kMost = 16;
  const Probe& probe = registry.get<Probe>(entity);
  std::vector<EffectTip> tips;
  std::uint32_t number = 0;
  for (const ProbePart& part : probe_parts(probe)) {
    const dvec3 axis = part.to - part.from;
    const double apart = std::max(0.5 * probe.radius, length(axis) / (kMost - 1));
    const int count = part.is_sphere() ? 0 : std::max(1, static_cast<int>(std::ceil(length(axis) / apart)));
    for (int i = 0; i <= count; ++i)
      tips.push_back({part.from + axis * (double(i) / std::max(count, 1)), number, {}, {}});
    ++number;
  }
  return tips;
}

bool is_felt(const Registry& registry, Entity effect, Entity probe) {
  const std::vector<std::string>& names = registry.get<Effect>(effect).probes;
  const Name* const name = registry.find<Name>(probe);
  return names.empty() || (name && std::find(names.begin(), names.end(), name->value) != names.end());
}

}  // namespace

void effects(World& world, Tick tick) {
  Registry& registry = world.registry;
  for (auto [entity, felt] : registry.view<FeltEffects>()) begin(felt);
  for (auto [entity, pair] : registry.view<EffectPair>()) {
    if (!registry.get<Probe>(pair.probe).placed) continue;
    FeltEffects& felt = registry.get<FeltEffects>(pair.probe);
    act(world, pair, tick, felt);
    tell_detents(world, pair, tick);
  }
  for (auto [entity, felt, probe] : registry.view<FeltEffects, Probe>()) {
    felt.stiffness = positive_part(felt.stiffness);
    limit(felt, registry.get<HapticDevice>(probe.device).max_stiffness);
    probe.force += felt.force + felt.drag;
    probe.torque += felt.torque + felt.drag_torque;
  }
}

Status prepare_effects(World& world) {
  Registry& registry = world.registry;
  std::vector<Entity> sources, gone;
  for (auto [entity, effect] : registry.view<const Effect>()) sources.push_back(entity);
  for (const Entity entity : sources) {
    const Effect& effect = registry.get<Effect>(entity);
    if (!effect.points.valid()) continue;
    GuidedBy& guided =
        registry.has<GuidedBy>(entity) ? registry.get<GuidedBy>(entity) : registry.add<GuidedBy>(entity, GuidedBy{});
    guided.path = GuidePath(world.paths[effect.points]);
  }
  std::vector<std::pair<Entity, Entity>> known;
  for (auto [entity, pair] : registry.view<EffectPair>()) {
    if (registry.alive(pair.effect) && registry.has<Effect>(pair.effect) && registry.alive(pair.probe) &&
        registry.has<Probe>(pair.probe))
      known.emplace_back(pair.effect, pair.probe);
    else
      gone.push_back(entity);
  }
  for (const Entity entity : gone) registry.destroy(entity);
  for (const ProbeState& state : world.touch->probes) {
    if (!sources.empty() && !registry.has<FeltEffects>(state.entity)) registry.add<FeltEffects>(state.entity, {});
    for (const Entity source : sources)
      if (is_felt(registry, source, state.entity) &&
          std::find(known.begin(), known.end(), std::pair(source, state.entity)) == known.end())
        registry.add<EffectPair>(registry.create(), {source, state.entity, tips_of_effects(registry, state.entity)});
  }
  return Done{};
}

}  // namespace pliant
