#include "systems/tool/tool_feedback.h"

#include <algorithm>
#include <cmath>

#include "components/soft_body.h"
#include "systems/tool/coupling.h"
#include "systems/tool/rotation_vector.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

// Device pose and, from two of them, velocity. False: nothing is known, and nothing may be felt.
bool sense(ToolTouchState& tool, const HapticDevice& device, double dt) {
  const double size = glm::dot(device.rotation, device.rotation);
  if (device.status != DeviceStatus::kReady || !plausible_position(device.position) || !(std::abs(size - 1.0) < 1e-3))
    return tool.sensing = false;
  const RigidMotion before = tool.sensed;
  tool.sensed.pose = {device.position, glm::normalize(device.rotation)};
  tool.sensed.velocity.setZero();
  if (tool.sensing) {
    const dvec3 turn = vector_of(tool.sensed.pose.rotation * glm::conjugate(before.pose.rotation));
    tool.sensed.velocity = join((tool.sensed.pose.position - before.pose.position) / dt, turn / dt);
    tool.turned += turn;
  }
  return tool.sensing = true;
}

// Where the handle stands seen from the model.
Vector6 displacement(const RigidMotion& from, const RigidMotion& to) {
  return join(to.pose.position - from.pose.position, vector_of(to.pose.rotation * glm::conjugate(from.pose.rotation)));
}

// From the next tick on. Whatever the wrench was, it goes on from there: that tick finds by how much the new
// description differs, all inertia included, and the difference fades.
void use(ToolTouchState& tool, ToolForce force) {
  tool.used = force;
  tool.joins = true;
}

void adopt(ToolTouchState& tool, const HandleModel& model) {
  if (!tool.placed) {
    tool.handle = model.handle;
    tool.wrench = model.force;
    tool.placed = true;
  }
  tool.displacement = displacement(model.handle, tool.handle);
  tool.contacts.start(model.contacts);
  tool.late = 0;
  use(tool, tool.wanted);
}

// The model fades to nothing once it is too old to be believed; until then 1.
double trust(const HandleModel& model, double time) {
  const double late = time - model.time - kStaleSteps * model.soft_step;
  return late <= 0.0 ? 1.0 : std::exp(-late / (kFadeShare * model.soft_step));
}

LinearModel scaled(const LinearModel& model, double factor) {
  return {model.force * factor, model.stiffness * factor, model.damping * factor, model.mass * factor};
}

// One implicit step of the handle between device and model.
void step(ToolTouchState& tool, const HandleModel& model, const Handle6& settings, Tick tick) {
  const RigidMotion target = tool.sensed.at(model.centre);
  const CouplingForce coupling = coupling_force(settings, tool.handle, target);
  const CouplingStep bond = coupling_step(coupling, tool.handle, target, tick.dt);
  TickHandle handle;
  handle.velocity = tool.handle.velocity;
  handle.inertia = model.handle_mass;
  handle.inertia.diagonal() += bond.matrix;
  // What carries the tool is as old as the flesh's weight in the model: without the one, the other would lift the hand.
  const double believed = trust(model, tick.time);
  const Vector6 felt = tool.wrench;
  if (believed < 1.0 && tool.used != ToolForce::kLinear) use(tool, ToolForce::kLinear);
  if (tool.joins) tool.fade.setZero();
  handle.right =
      model.handle_mass * tool.handle.velocity + bond.right + tick.dt * (believed * model.handle_load + tool.fade);
  switch (tool.used) {
    case ToolForce::kHeld: {
      LinearModel held;
      held.force = model.force;
      tool.wrench = linear_tick(held, Vector6::Zero(), Vector6::Zero(), tick.dt, handle);
      break;
    }
    case ToolForce::kLinear:
      tool.wrench =
          linear_tick(scaled(model.linear, believed), model.handle.velocity, tool.displacement, tick.dt, handle);
      break;
    case ToolForce::kContacts:
      tool.wrench = condensed_tick(model.contacts, tool.contacts, tool.limits, handle);
      tool.late = tool.contacts.report.in_time ? 0 : tool.late + 1;
      tool.ticks_late += !tool.contacts.report.in_time;
      break;
  }
  if (tool.joins) tool.fade = believed * felt - tool.wrench;
  tool.joins = false;
  tool.wrench += tool.fade;
  tool.fade *= std::exp(-tick.dt / (kFadeShare * model.soft_step));

  tool.handle.velocity = handle.velocity;
  tool.handle.pose.position += tick.dt * linear(handle.velocity);
  tool.handle.pose.rotation =
      glm::normalize(rotation_of(tick.dt * angular(handle.velocity)) * tool.handle.pose.rotation);
  tool.displacement = displacement(model.handle, tool.handle);
  if (tool.late >= kLateTicks && tool.used == ToolForce::kContacts) use(tool, ToolForce::kLinear);
}

// What the coupling does to the device, at the device's own origin. Before the step: device and handle of one moment. A
// handle one tick ahead would push a moving hand on, by k v dt.
void pull_device(ToolTouchState& tool, const HandleModel& model, const Handle6& settings) {
  const RigidMotion target = tool.sensed.at(model.centre);
  const Vector6 wrench = -coupling_force(settings, tool.handle, target).wrench;
  const dvec3 arm = target.pose.position - tool.sensed.pose.position;
  tool.device_wrench = join(linear(wrench), angular(wrench) + cross(arm, linear(wrench)));
}

bool finite(const RigidMotion& motion) {
  const dvec3 x = motion.pose.position;
  const dquat q = motion.pose.rotation;
  return std::isfinite(dot(x, x)) && std::isfinite(glm::dot(q, q)) && motion.velocity.allFinite();
}

// A model that is no number must not stay in the handle: nothing is felt until the next one.
void forget(ToolTouchState& tool) {
  tool.placed = false;
  tool.handle = tool.sensed;
  tool.fade.setZero();
  tool.wrench.setZero();
  tool.device_wrench.setZero();
}

void tell_soft_clock(ToolTouchState& tool, Tick tick) {
  ToolInput& input = tool.input.write();
  input.status = tool.sensing ? DeviceStatus::kReady : DeviceStatus::kLost;
  input.time = tool.placed ? tick.time + tick.dt : tick.time;
  input.tick = tick.dt;
  input.device = tool.sensed;
  input.placed = tool.placed;
  input.handle = tool.handle;
  tool.input.publish();
  if (tool.placed) tool.path.push({tick.time + tick.dt, tool.handle.velocity});
}

void feel(World& world, ToolTouchState& tool, Tick tick) {
  const Handle6& settings = world.registry.get<Handle6>(tool.entity);
  tool.device_wrench.setZero();
  const bool sensing = sense(tool, world.registry.get<HapticDevice>(tool.device), tick.dt);
  if (tool.model.acquire()) adopt(tool, tool.model.read());
  const HandleModel& model = tool.model.read();
  if (tool.placed && sensing) {
    pull_device(tool, model, settings);
    step(tool, model, settings, tick);
    if (!finite(tool.handle)) {
      world.dropped |= kDroppedNonFinite;
      forget(tool);
    }
  } else {  // the handle stays where it is until there is a device to go to
    tool.handle.velocity.setZero();
    tool.sensed.velocity.setZero();
  }
  tell_soft_clock(tool, tick);
}

}  // namespace

void tool_feedback(World& world, Tick tick) {
  if (!world.tools) return;
  for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools) feel(world, *tool, tick);
}

}  // namespace pliant
