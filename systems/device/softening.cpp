#include "systems/device/softening.h"

#include <algorithm>

#include "components/soft_body.h"
#include "systems/effects/felt_effects.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/feed/contacts_of.h"

namespace pliant {
namespace {

// An upper bound of the largest eigenvalue of a symmetric matrix: its largest row sum.
double at_least_largest(const dmat3& m) {
  double most = 0.0;
  for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(m[0][i]) + std::abs(m[1][i]) + std::abs(m[2][i]));
  return most;
}

// The larger of the law's slope at this depth and its force over the depth: of a softening law the slope alone would
// say that the hand had gone far for its force, and credit energy that it never gave.
double steepest(const Contact& contact) {
  const double depth = -contact.height - contact.unpushed;
  return depth > 0.0 ? std::max(contact.stiffness, contact.normal_force / depth) : contact.stiffness;
}

template <class Stiffness>
double stiffness_of(const World& world, Entity effector, const Stiffness& of) {
  double stiffness = 0.0;
  if (const ToolTouchState* const tool = find_tool(world, effector); tool && tool->placed() && tool->sensing)
    stiffness += settings_of(world, *tool).translation[0];
  if (!world.registry.has<Probe>(effector)) return stiffness;
  dmat3 sum(0.0);
  for_contacts_of(world, effector, [&](const Contact& contact) {
    if (contact.state == ContactState::kTouching)
      sum += of(contact) * glm::outerProduct(contact.gradient, contact.gradient);
  });
  return stiffness + at_least_largest(sum);
}

}  // namespace

double felt_stiffness(const World& world, Entity effector) {
  const FeltEffects* const effects = world.registry.find<FeltEffects>(effector);
  return stiffness_of(world, effector, [](const Contact& contact) { return contact.stiffness; }) +
         (effects ? at_least_largest(effects->stiffness) : 0.0);
}

double soften(const World& world, Entity effector, const HapticDevice& device, SafetyState& state) {
  const double most = device.can.max_stiffness, felt = felt_stiffness(world, effector) * device.workspace;
  if (!(felt > 0.0) || !(most > 0.0))
    state.share = 1.0;
  else if (felt * state.share > most)
    state.share = most / felt;
  state.least_share = std::min(state.least_share, state.share);
  return stiffness_of(world, effector, steepest) * device.workspace * state.share;
}

SafetyState* safety_of(World& world, Entity hand) {
  if (world.touch)
    for (ProbeState& probe : world.touch->probes)
      if (probe.entity == hand) return &probe.safety;
  ToolTouchState* const tool = find_tool(world, hand);
  return tool ? &tool->force_safety : nullptr;
}

}  // namespace pliant
