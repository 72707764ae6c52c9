#include "systems/device/device_model.h"

#include <algorithm>
#include <cmath>

#include "components/soft_body.h"
#include "systems/device/devices.h"
#include "systems/effects/felt_effects.h"
#include "systems/soft/body/coupling.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/feed/contacts_of.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

// Of the wanted force, before safety: minus its derivatives.
struct Slopes {
  dmat3 stiffness{0.0}, damping{0.0};                  // -d force / d position, -d force / d velocity
  dmat3 lever_stiffness{0.0};                          // -d force / d rotation; its transpose: -d torque / d position
  dmat3 turning_stiffness{0.0}, turning_damping{0.0};  // -d torque / d rotation, -d torque / d spin
  dvec3 wanted_force{0}, wanted_torque{0}, velocity{0}, spin{0}, of{0};  // `of`: velocity of the touched surface
};

dmat3 block(const Matrix6& m, int row, int column) {
  dmat3 out;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out[j][i] = m(row + i, column + j);
  return out;
}

// Valid where pose and handle are of the same time (tool_feedback.cpp: pull_device).
void add_coupling(const World& world, const ToolTouchState& tool, Slopes& slopes) {
  if (!tool.placed() || !tool.sensing) return;
  const HandleModel& model = tool.model.read();
  const RigidMotion target = tool.sensed.at(model.centre);
  const CouplingForce bond = coupling_force(settings_of(world, tool), tool.handle, target);
  // The device's twist maps to the target's by the arm between them; wrenches map back by its transpose.
  const Grip grip = grip_matrix(target.pose.position - tool.sensed.pose.position);
  Matrix6 arm = Matrix6::Identity();
  arm.topRows<3>() = grip;
  const Matrix6 stiffness = arm.transpose() * bond.stiffness * arm, damping = arm.transpose() * bond.damping * arm;
  slopes.stiffness += block(stiffness, 0, 0);
  slopes.lever_stiffness += block(stiffness, 0, 3);
  slopes.turning_stiffness += block(stiffness, 3, 3);
  slopes.damping += block(damping, 0, 0);
  slopes.turning_damping += block(damping, 3, 3);
  const Vector6& w = tool.handle.velocity;
  slopes.of = linear(w) + cross(angular(w), tool.sensed.pose.position - tool.handle.pose.position);
}

void add_contacts(const World& world, Entity probe, Slopes& slopes) {
  for_contacts_of(world, probe, [&](const Contact& contact) {
    if (contact.state != ContactState::kTouching) return;
    const dvec3 normal = world.registry.get<Pose>(contact.object).rotation * contact.normal;
    const dmat3 along = glm::outerProduct(contact.gradient, contact.gradient);
    const dmat3 across = dmat3(1.0) - glm::outerProduct(normal, normal);
    slopes.stiffness += contact.stiffness * along + contact.bristle_stiffness * across;
    slopes.damping += contact.damping * along + contact.bristle_damping * across;
  });
}

void add_effects(const World& world, Entity probe, Slopes& slopes) {
  const FeltEffects* const felt = world.registry.find<FeltEffects>(probe);
  if (!felt) return;
  slopes.stiffness += felt->stiffness;
  slopes.damping += dmat3(felt->damping);
}

// Remaining part of a slope matrix, applied on both sides, where the safety layer reduced the force.
struct Passed {
  double share = 1.0;  // [1]
  dmat3 side{1.0};     // a projection
};
Passed passed(dvec3 wanted, dvec3 sent, const SafetyState& safety, double limit) {
  Passed out;
  const double size = length(wanted);
  if (!safety.engaged) out.share = 0.0;
  if (!(size > 1e-9)) return out;
  if (size > limit) {  // the norm is clamped: no slope along the force; across it the slope scales with the share
    const dvec3 direction = wanted / size;
    out.side = dmat3(1.0) - glm::outerProduct(direction, direction);
  }
  out.share *= std::clamp(dot(sent, wanted) / (size * size), 0.0, 1.0);
  return out;
}

double row_sum(const dmat3& m) {
  double most = 0.0;
  for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(m[0][i]) + std::abs(m[1][i]) + std::abs(m[2][i]));
  return most;
}

}  // namespace

DeviceModel device_model(const World& world, Entity effector, Entity entity, Tick tick) {
  const HapticDevice& device = world.registry.get<HapticDevice>(entity);
  const double scale = device.workspace;
  const SafetyLimits limits = force_limits(device);
  DeviceModel model;
  model.time = tick.time;
  model.position = (device.position - device.origin) / scale;
  model.rotation = device.rotation;
  model.wrench = {device.force_sent, device.torque_sent};
  model.max_force = limits.force;

  Slopes slopes;
  const SafetyState* pushing = nullptr;
  const SafetyState* turning = nullptr;
  const ToolTouchState* const tool = find_tool(world, effector);
  if (const Probe* const probe = world.registry.find<Probe>(effector)) {
    for (const ProbeState& state : world.touch->probes)
      if (state.entity == effector) {
        pushing = &state.safety;
        if (state.lever > 0) turning = &state.torque_safety;
      }
    if (turning) model.max_torque = probe_torque_limits(device).force;
    add_contacts(world, effector, slopes);
    add_effects(world, effector, slopes);
    slopes.of = surface_displacement(world, effector, tick.dt) / tick.dt;
    model.carried = slopes.of / scale;
    if (tool) add_coupling(world, *tool, slopes);
    slopes.wanted_force = probe->force + (tool ? linear(tool->device_wrench) : dvec3(0));
    slopes.wanted_torque = probe->torque;
    slopes.velocity = probe->velocity;
    if (pushing) model.weight = pushing->weight;
  } else if (tool) {
    pushing = &tool->force_safety;
    turning = &tool->torque_safety;
    add_coupling(world, *tool, slopes);
    slopes.wanted_force = linear(tool->device_wrench);
    slopes.wanted_torque = angular(tool->device_wrench);
    slopes.velocity = linear(tool->sensed.velocity);
    slopes.spin = angular(tool->sensed.velocity);
    model.weight = tool->force_safety.weight;
    model.max_torque = torque_limits(device, settings_of(world, *tool)).force;
  }
  if (!pushing) return model;
  model.easing = pushing->eased < 1.0 || (turning && turning->eased < 1.0);
  for (dmat3* slope : {&slopes.stiffness, &slopes.damping, &slopes.lever_stiffness, &slopes.turning_stiffness,
                       &slopes.turning_damping})
    *slope *= pushing->share;
  slopes.wanted_force *= pushing->share;
  slopes.wanted_torque *= pushing->share;
  slopes.wanted_force += pushing->own;
  if (turning) slopes.wanted_torque += turning->own;

  const Passed push = passed(slopes.wanted_force, device.force_sent, *pushing, limits.force);
  const Passed turn =
      turning ? passed(slopes.wanted_torque, device.torque_sent, *turning, model.max_torque) : Passed{0.0, dmat3(1.0)};
  const double both = std::min(push.share, turn.share);
  dmat3 stiffness = push.share * push.side * slopes.stiffness * push.side * scale;
  if (const double most = row_sum(stiffness); limits.stiffness > 0.0 && most > limits.stiffness)
    stiffness *= limits.stiffness / most;
  model.force_by_position = -stiffness;
  model.force_by_velocity = -push.share * push.side * slopes.damping * push.side * scale;
  // Off the diagonal at most the smaller share of both, so that the whole matrix stays negative semi-definite.
  model.force_by_turn = -both * push.side * slopes.lever_stiffness * turn.side;
  model.torque_by_position = glm::transpose(model.force_by_turn) * scale;
  model.torque_by_turn = -turn.share * turn.side * slopes.turning_stiffness * turn.side;
  model.torque_by_spin = -turn.share * turn.side * slopes.turning_damping * turn.side;
  model.velocity = slopes.of / scale;
  model.wrench.force -= model.force_by_velocity * ((slopes.velocity - slopes.of) / scale);
  model.wrench.torque -= model.torque_by_spin * slopes.spin;
  return model;
}

}  // namespace pliant
