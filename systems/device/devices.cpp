#include "systems/device/devices.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "components/soft_body.h"
#include "systems/device/mouse.h"
#include "systems/device/path.h"
#include "systems/device/softening.h"
#include "systems/device/tissue_account.h"
#include "systems/effects/effect_account.h"
#include "systems/effects/felt_effects.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/feed/contacts_of.h"

namespace pliant {
namespace {

// Samples drivers with prescribed motion. The motion is in world coordinates, so `scale` does not apply. Other drivers
// have written position and sensed_at themselves.
void sense(const World& world, HapticDevice& device, double time) {
  if (!device.path.valid()) return;
  const PathRow row = sample_path(world.paths[device.path], time);
  device.position = row.position;
  device.rotation = row.rotation;
  device.grip = row.grip, device.grips = world.paths[device.path].grips;
  device.sensed_at = time;
}

// A force that the device does not render counts as zero: it is neither clipped nor missing.
dvec3 rendered(dvec3 wanted, bool renders) {
  return renders ? wanted : dvec3(0);
}

// [s] In which a tool's force comes back after a stall: soft matter that was left behind catches up, and a longer way
// takes it longer.
double ease_of_tool(double skipped) {
  constexpr double kShare = 0.6, kLongest = 0.3;  // [1] of the stall, [s]
  return std::clamp(kShare * skipped, kToolEase, kLongest);
}

bool all_finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void note_events(World& world, const SafetyResult& result) {
  if (result.event == SafetyEvent::kNonFinite) world.dropped |= kDroppedNonFinite;
  if (result.event == SafetyEvent::kStale) world.dropped |= kDroppedStale;
  if (result.event == SafetyEvent::kJumped) world.dropped |= kDroppedJump;
}

// A force and a torque, or a force alone.
struct SafetyPair {
  SafetyState& force;
  SafetyState* torque;  // null: none
  dvec3 turned{0};      // [rad] place of the torque: sum of the small rotations
};

// A wrench, by the same layer: its torque as if it were a force, work counted over the angles turned. Both are let go
// and engaged together. They share one account of energy: a push at a fingertip is a force and a torque about the
// wrist, which give and take only together. NaN: unknown.
void write_wrench(World& world, HapticDevice& device, const SafetyPair& safety, SafetyLimits limits,
                  SafetyLimits turning, dvec3 force, dvec3 torque, Tick tick) {
  if (safety.torque) {
    limits.jumped = turning.jumped = jumps(safety.force, device, limits, device.position, tick.dt) ||
                                     jumps(*safety.torque, device, turning, safety.turned, tick.dt);
  }
  const SafetyResult push = make_safe(safety.force, device, limits, force, device.position, tick.time, tick.dt);
  note_events(world, push);
  device.force_sent = push.force;
  device.torque_sent = dvec3(0);
  if (!safety.torque) return;
  safety.torque->work = safety.force.work;
  const SafetyResult turn = make_safe(*safety.torque, device, turning, torque, safety.turned, tick.time, tick.dt);
  note_events(world, turn);
  safety.force.work = safety.torque->work;
  device.torque_sent = turn.force;
}

// [J] of the hand, since the last tick: what drives and kinematic bodies gave may reach the hand.
double fed_since(ToolTouchState& tool) {
  const double before = tool.fed;
  tool.fed = tool.model.read().fed;
  return std::isfinite(tool.fed - before) ? tool.force_safety.share * (tool.fed - before) : 0.0;
}

void write_tool(World& world, ToolTouchState& tool, Tick tick) {
  HapticDevice& device = world.registry.get<HapticDevice>(tool.device);
  const Handle6& handle = world.registry.get<Handle6>(tool.entity);
  const bool posed = tool.sensing || device.status != DeviceStatus::kReady;  // ready without a pose: unknown pose
  const bool known = posed && tool.device_wrench.allFinite();
  const dvec3 unknown(std::numeric_limits<double>::quiet_NaN());
  SafetyLimits limits = force_limits(device), turning = torque_limits(device, handle);
  limits.touched = soften(world, tool.entity, device, tool.force_safety);
  turning.touched = tool.force_safety.share * handle.rotation[0];
  limits.ease = turning.ease = ease_of_tool(tick.skipped);
  limits.stiffened = fed_since(tool);
  limits.weight = tool.force_safety.share * tool.weight;
  turning.weight = cross(tool.sensed.pose.rotation * tool.balance, limits.weight);
  const dvec3 push =
      known
          ? rendered(with_own(tool.force_safety, limits, tool.force_safety.share * linear(tool.device_wrench), tick.dt),
                     device.can.renders_force)
          : unknown;
  const dvec3 turn = known ? rendered(with_own(tool.torque_safety, turning,
                                               tool.force_safety.share * angular(tool.device_wrench), tick.dt),
                                      device.can.renders_torque)
                           : unknown;
  write_wrench(world, device, {tool.force_safety, &tool.torque_safety, tool.turned}, limits, turning, push, turn, tick);
}

void write_probe(World& world, ProbeState& state, Tick tick) {
  const Probe& probe = world.registry.get<Probe>(state.entity);
  HapticDevice& device = world.registry.get<HapticDevice>(probe.device);
  SafetyLimits limits = force_limits(device), turning = probe_torque_limits(device);
  limits.touched = soften(world, state.entity, device, state.safety);
  turning.touched = limits.touched * state.lever * state.lever;
  limits.carried = surface_displacement(world, state.entity, tick.elapsed());
  limits.stiffened = state.stiffened * joules_of(world, state);
  if (!std::isfinite(limits.stiffened)) limits.stiffened = 0.0;  // a NaN in the account would allow any work
  if (state.safety.engaged) state.stiffened_sum += std::max(0.0, limits.stiffened);
  const BesideObserver beside = effects_beside(world, state.entity, state.safety.share);
  limits.weight = beside.force;
  turning.weight = beside.torque;
  const ToolTouchState* const among_bodies = find_tool(world, state.entity);
  if (among_bodies) limits.ease = turning.ease = ease_of_tool(tick.skipped);
  const dvec3 pressed = with_own(
      state.safety, limits,
      state.safety.share * (probe.force + (among_bodies ? linear(among_bodies->device_wrench) : dvec3(0))), tick.dt);
  const dvec3 unknown(std::numeric_limits<double>::quiet_NaN());
  const bool known = plausible_rotation(device.rotation) && all_finite(pressed) && all_finite(probe.torque);
  const dvec3 turn =
      probe.placed && !probe.fresh ? vector_of(probe.rotation * glm::conjugate(probe.previous_rotation)) : dvec3(0);
  state.turned += turn;
  write_wrench(world, device, {state.safety, state.lever > 0 ? &state.torque_safety : nullptr, state.turned}, limits,
               turning, known ? rendered(pressed, device.can.renders_force) : unknown,
               known ? rendered(state.safety.share * probe.torque, device.can.renders_torque) : unknown, tick);
  const bool turns = state.lever > 0 && device.can.renders_torque;
  keep_account(world, state.entity, state.safety, state.safety.share, turns ? dvec3(0) : turn);
}

}  // namespace

dvec3 surface_displacement(const World& world, Entity probe, double dt) {
  const Registry& registry = world.registry;
  dvec3 sum(0);
  double forces = 0.0;
  for_contacts_of(world, probe, [&](const Contact& contact) {
    const double force = length(contact.force);
    if (!(force > 0.0)) return;
    forces += force;
    if (!registry.has<MovingPose>(contact.object)) return;
    const dvec3 at = registry.get<Pose>(contact.object).to_world(contact.foot);
    sum += force * dt * surface_velocity(registry, contact.object, at);
  });
  if (const FeltEffects* const felt = registry.find<FeltEffects>(probe)) {
    forces += length(felt->drag);
    sum += dt * felt->carried;
  }
  return forces > 0.0 ? sum / forces : dvec3(0);
}

void read_devices(World& world, Tick tick) {
  read_mouse(world, tick);
  for (auto [entity, device] : world.registry.view<HapticDevice>()) sense(world, device, tick.time);
  for (auto [entity, probe] : world.registry.view<Probe>()) {
    const HapticDevice& device = world.registry.get<HapticDevice>(probe.device);
    if (!plausible_position(device.position) || !plausible_rotation(device.rotation)) {
      world.dropped |= kDroppedNonFinite;  // the probe keeps its position; safety sends no force
      probe.velocity = dvec3(0);
      probe.previous = probe.position;
      probe.previous_rotation = probe.rotation;
      continue;
    }
    probe.fresh = !probe.placed;
    probe.previous = probe.placed ? probe.position : device.position;
    probe.previous_rotation = probe.placed ? probe.rotation : glm::normalize(device.rotation);
    probe.position = device.position;
    probe.rotation = glm::normalize(device.rotation);
    probe.velocity = (probe.position - probe.previous) / tick.elapsed();
    probe.placed = true;
    if (length(probe.position - probe.previous) > world.touch->extent) world.dropped |= kDroppedTravel;
  }
}

void write_devices(World& world, Tick tick) {
  share_accounts(world, tick);
  for (ProbeState& state : world.touch->probes) write_probe(world, state, tick);
  if (!world.tools) return;
  for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools)
    if (!tool->is_probe) write_tool(world, *tool, tick);
}

void set_hand_force(World& world, Entity hand, dvec3 force, dvec3 torque) {
  for (ProbeState& state : world.touch->probes)
    if (state.entity == hand) state.safety.added = force;
  ToolTouchState* const tool = find_tool(world, hand);
  if (!tool) return;
  tool->force_safety.added = force;
  tool->torque_safety.added = torque;
}

void begin_anew(World& world, Entity hand) {
  const auto anew = [](SafetyState& safety) {
    SafetyState next;
    next.tally = safety.tally;
    next.least_share = safety.least_share;
    next.added = safety.added;
    safety = next;
  };
  for (ProbeState& state : world.touch->probes)
    if (state.entity == hand) {
      anew(state.safety);
      anew(state.torque_safety);
    }
  if (Probe* probe = world.registry.find<Probe>(hand)) probe->placed = false;
  ToolTouchState* const tool = find_tool(world, hand);
  if (!tool) return;
  anew(tool->force_safety);
  anew(tool->torque_safety);
  tool->sensing = false;
}

}  // namespace pliant
