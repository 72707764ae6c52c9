#include "systems/tool/tool_feedback.h"

#include <algorithm>
#include <cmath>

#include "components/soft_body.h"
#include "systems/safety/safety.h"
#include "systems/soft/body/coupling.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/tool/pull.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

// Device pose and, by differences, velocity. The time between two poses is longer than a tick if the clock skipped
// some. Over one tick alone, the coupling's damper would respond to a late tick with a blow. False: the state is
// unknown, and the force is zero. `missed` [s]: length of the ticks between the two poses.
bool sense(ToolTouchState& tool, const HapticDevice& device, Tick tick, double& missed) {
  missed = 0.0;
  if (device.status != DeviceStatus::kReady || !plausible_position(device.position) ||
      !plausible_rotation(device.rotation))
    return tool.sensing = false;
  const RigidMotion before = tool.sensed;
  const double since = tick.time - tool.sensed_at;
  const double dt = since > 1.5 * tick.dt ? since : tick.dt;  // without rounding where no tick was skipped
  if (tool.sensing) missed = dt - tick.dt;
  tool.sensed_at = tick.time;
  tool.sensed.pose = {device.position, glm::normalize(device.rotation)};
  tool.sensed.velocity.setZero();
  if (tool.sensing) {
    const dvec3 turn = vector_of(tool.sensed.pose.rotation * glm::conjugate(before.pose.rotation));
    const dvec3 went = tool.sensed.pose.position - before.pose.position;
    // A jump has no velocity for damping.
    if (length(went) < kFastestHand * device.workspace * dt && length(turn) < kFastestTurn * dt)
      tool.sensed.velocity = join(went / dt, turn / dt);
    else
      missed = 0.0;
    tool.turned += turn;
  }
  return tool.sensing = true;
}

// Displacement of the handle from the model's pose.
Vector6 displacement(const RigidMotion& from, const RigidMotion& to) {
  return join(to.pose.position - from.pose.position, vector_of(to.pose.rotation * glm::conjugate(from.pose.rotation)));
}

// From the next tick on. The wrench continues from its last value; the difference to the new description fades.
void use(ToolTouchState& tool, ToolForce force) {
  tool.used = force;
  if (force != ToolForce::kContacts) tool.owed.setZero();  // other descriptions have no bodies of their own
  tool.joins = true;
  tool.settling = 0;
}

// Half of a short soft step. None if the contacts alone describe the resistance (stiff_contacts.h).
int settle_ticks(const HandleModel& model) {
  const CondensedContacts& contacts = model.contacts;
  if (has_stiff(contacts)) return 0;
  return std::clamp(static_cast<int>(0.5 * model.soft_step / contacts.tick), 1, kSettleTicks);
}

void adopt(ToolTouchState& tool, const HandleModel& model) {
  if (model.aside) return;
  const bool moved = model.set_backs != tool.models_set_back;  // by the soft clock
  tool.models_set_back = model.set_backs;
  const bool waits = tool.state == HandleState::kSetBack || tool.state == HandleState::kReturns;
  if (waits && !moved) return;
  if (moved || !tool.placed()) {
    const bool at_device = tool.state == HandleState::kReturns && tool.sensing;  // no initial stretch of the spring
    tool.handle = at_device ? tool.sensed.at(model.centre) : model.handle;
    tool.wrench = model.force;
    tool.state = HandleState::kFollows;
  }
  tool.displacement = displacement(model.handle, tool.handle);
  tool.contacts.start(model.contacts);
  tool.late = 0;
  // A contact without compliance has no linear model: it would keep the handle wherever it was first met, and pull.
  const bool yields = tool.wanted != ToolForce::kLinear || !has_stiff(model.contacts);
  use(tool, yields ? tool.wanted : ToolForce::kContacts);
  if (tool.used == ToolForce::kContacts && model.owed.allFinite()) {
    tool.owed += model.soft_step * model.owed;
    tool.owed_left = std::max(1.0, model.owed_steps * model.soft_step / model.contacts.tick);
  }
  // A transfer no longer than a tick would begin anew with every model and keep the force constant.
  if (kJoinShare * model.soft_step <= model.contacts.tick) {
    tool.joins = false;
    tool.fade.setZero();
    return;
  }
  if (tool.used == ToolForce::kContacts) tool.settling = settle_ticks(model);
}

// The fade to a new description becomes shorter by one tick.
void fade_on(ToolTouchState& tool) {
  tool.fade *= std::max(0.0, 1.0 - 1.0 / tool.fade_left);
  tool.fade_left = std::max(1.0, tool.fade_left - 1.0);
}

// [N s], [N m s] In this tick.
Vector6 give_owed(ToolTouchState& tool) {
  const Vector6 now = tool.owed / std::max(1.0, tool.owed_left);
  tool.owed -= now;
  tool.owed_left -= 1.0;
  return now;
}

// 1, fading to zero once the model is too old.
double trust(const HandleModel& model, double time) {
  const double late = time - model.time - kStaleSteps * model.soft_step;
  return late <= 0.0 ? 1.0 : std::exp(-late / (kFadeShare * model.soft_step));
}

LinearModel scaled(const LinearModel& model, double factor) {
  return {model.force * factor, model.stiffness * factor, model.damping * factor, model.mass * factor};
}

// The model's wrench over a tick, without solving its contacts again.
Vector6 plain_tick(const ToolTouchState& tool, const HandleModel& model, double believed, double dt,
                   TickHandle& handle) {
  return linear_tick(scaled(model.linear, believed), model.handle.velocity, tool.displacement, dt, handle);
}

Vector6 contact_tick(ToolTouchState& tool, const HandleModel& model, TickHandle& handle) {
  const Vector6 wrench =
      condensed_tick(model.contacts, tool.contacts, sweep_limits(model.contacts, tool.limits), handle);
  tool.late = tool.contacts.report.in_time ? 0 : tool.late + 1;
  tool.ticks_late += !tool.contacts.report.in_time;
  return wrench;
}

// One implicit step of the handle between device and model.
//
// Bumpless transfer: a new description of the wrench gets an offset that keeps the wrench continuous if the handle
// continues its motion. If the offset were found while the handle follows the new description alone, it would contain
// the tissue's resistance to a jerk that is gone in the next tick. Besides, a new model's contacts stop within a tick
// or two all bodies that still approach each other at the step's end. So the contacts are first solved without effect,
// and the linear model gives only the response to changes of the handle's motion. It lacks the direction of the force
// where contacts slide.
void step(ToolTouchState& tool, const HandleModel& model, const Handle6& settings, Tick tick) {
  const RigidMotion target = tool.sensed.at(model.centre);
  const CouplingForce coupling = coupling_force(settings, tool.handle, target);
  const CouplingStep bond = coupling_step(coupling, tool.handle, target, tick.dt);
  TickHandle handle;
  handle.velocity = tool.handle.velocity;
  handle.inertia = model.handle_mass;
  handle.inertia.diagonal() += bond.matrix;
  // The force that supports the tool is as old as the tissue's weight in the model: without one, the other would lift
  // the hand.
  const double believed = trust(model, tick.time);
  if (believed < 1.0 && tool.used != ToolForce::kLinear) use(tool, ToolForce::kLinear);
  const Vector6 felt = believed * tool.wrench;
  const bool contacts_alone = tool.used == ToolForce::kContacts && tool.settling == 0;
  if (tool.joins || tool.settling > 0) {
    TickHandle same;
    same.velocity = handle.velocity;
    same.moved = true;
    same.next = handle.velocity + tool.gained;
    tool.fade = contacts_alone ? Vector6(Vector6::Zero()) : felt - plain_tick(tool, model, believed, tick.dt, same);
    tool.fade_left = kJoinShare * model.soft_step / tick.dt;
  }
  handle.right =
      model.handle_mass * tool.handle.velocity + bond.right + tick.dt * (believed * model.handle_load + tool.fade);
  if (contacts_alone) handle.right += give_owed(tool);
  tool.wrench = contacts_alone ? contact_tick(tool, model, handle) : plain_tick(tool, model, believed, tick.dt, handle);
  if (tool.joins && contacts_alone) tool.fade = felt - tool.wrench;
  tool.wrench += tool.fade;
  tool.joins = false;
  if (tool.settling > 0) {
    TickHandle led;
    led.velocity = tool.handle.velocity;
    led.moved = true;
    led.next = handle.velocity;
    const Vector6 contacts = contact_tick(tool, model, led);
    if (--tool.settling == 0) tool.fade = tool.wrench - contacts;
  }
  if (tool.settling == 0) fade_on(tool);

  if (tool.wrench.allFinite()) tool.impulse += tick.dt * tool.wrench;  // a sum would keep NaN forever
  tool.gained = handle.velocity - tool.handle.velocity;
  tool.handle.velocity = handle.velocity;
  tool.handle.pose.position += tick.dt * linear(handle.velocity);
  tool.handle.pose.rotation =
      glm::normalize(rotation_of(tick.dt * angular(handle.velocity)) * tool.handle.pose.rotation);
  tool.displacement = displacement(model.handle, tool.handle);
  if (tool.late >= kLateTicks && tool.used == ToolForce::kContacts) use(tool, ToolForce::kLinear);
}

// `wrench`: on the device at the handle's centre, moved to the device's origin.
void pull_device(ToolTouchState& tool, const HandleModel& model, const Vector6& wrench) {
  const dvec3 arm = tool.sensed.at(model.centre).pose.position - tool.sensed.pose.position;
  tool.device_wrench = join(linear(wrench), angular(wrench) + cross(arm, linear(wrench)));
}

// ToolForce::kHeld: handle and device are coupled by the soft step, implicitly, and the touch clock keeps its force. A
// handle that moved here under a constant force would meet nothing: contacts would hold it from one step to the next
// only, with the force that a hand needs for that step.
void hold(ToolTouchState& tool, const HandleModel& model, Tick tick) {
  const double believed = trust(model, tick.time);
  const Vector6 now = believed * model.passed_on;
  if (tool.joins) {
    tool.fade = believed * tool.wrench - now;
    if (!tool.fade.allFinite()) tool.fade.setZero();  // a sum would keep NaN forever
    tool.fade_left = std::max(1.0, kJoinShare * model.soft_step / tick.dt);
  }
  tool.joins = false;
  tool.handle = model.handle;
  tool.wrench = now + tool.fade;
  fade_on(tool);
  pull_device(tool, model, tool.wrench + believed * model.handle_load);
}

bool motion_is_finite(const RigidMotion& motion) {
  const dvec3 x = motion.pose.position;
  const dquat q = motion.pose.rotation;
  return std::isfinite(dot(x, x)) && std::isfinite(glm::dot(q, q)) && motion.velocity.allFinite();
}

// Farther from its device, or faster, than any tool in a hand.
bool got_away(const ToolTouchState& tool, const HandleModel& model) {
  const Vector6 speed = tool.handle.velocity - tool.sensed.velocity;
  return length(tool.sensed.at(model.centre).pose.position - tool.handle.pose.position) > kMostStretch ||
         length(linear(speed)) > kRunaway || length(angular(speed)) > kRunawayTurn;
}

// The force is zero until the handle is placed again.
void unplace(ToolTouchState& tool, HandleState state) {
  tool.state = state;
  tool.handle = tool.sensed;
  tool.gained.setZero();
  tool.fade.setZero();
  tool.owed.setZero();
  tool.wrench.setZero();
  tool.device_wrench.setZero();
}

// A probe that hovers or pulls has no contacts with bodies: it is at its device. Afterwards it is set back there once
// more, and waits for the first model in which it has contacts again.
bool stands_aside(const World& world, ToolTouchState& tool) {
  if (!tool.is_probe) return false;
  const ProbeHold& hold = world.registry.get<Probe>(tool.entity).hold;
  const bool was = tool.aside;
  tool.aside = hold.hovers || !(hold.body == kNoEntity);
  if (!tool.aside && !was) return false;
  ++tool.set_backs;
  unplace(tool, HandleState::kReturns);
  return tool.aside;
}

// The spring of a pull (pull.h), on the device: the pulled patch is extrapolated from the soft step.
void feel_pull(const World& world, ToolTouchState& tool, const HandleModel& model, const Handle6& settings, Tick tick) {
  const PullModel& pull = model.pull;
  const ProbeHold& hold = world.registry.get<Probe>(tool.entity).hold;
  if (hold.body == kNoEntity || pull.number != hold.number) return;
  const double since = std::clamp(tick.time - pull.time, 0.0, kStaleSteps * model.soft_step);
  const dvec3 stretch = pull.point + since * pull.velocity - tool.sensed.pose.position;
  const double most = world.registry.get<HapticDevice>(tool.device).max_force;
  const dvec3 force = pull_force(stretch, pull.share * settings.translation[0], most);
  tool.device_wrench = join(trust(model, tick.time) * force, dvec3(0));
}

void send_to_soft_clock(const World& world, ToolTouchState& tool, Tick tick) {
  const bool leads = tool.placed() && tool.wanted != ToolForce::kHeld;  // the soft clock's handle
  ToolInput& input = tool.input.write();
  input.status = tool.sensing ? DeviceStatus::kReady : DeviceStatus::kLost;
  input.time = leads ? tick.time + tick.dt : tick.time;
  input.tick = tick.dt;
  input.device = tool.sensed;
  input.placed = leads;
  input.handle = tool.handle;
  input.impulse = tool.impulse;
  input.grip = world.registry.get<HapticDevice>(tool.device).grip;
  input.set_backs = tool.set_backs;
  input.seen = tool.models_set_back;
  if (tool.is_probe) {
    input.hold = world.registry.get<Probe>(tool.entity).hold;
    input.max_force = world.registry.get<HapticDevice>(tool.device).max_force;
  }
  tool.input.publish();
  if (leads) tool.path.push({tick.time + tick.dt, tool.handle.velocity});
}

// The device between two poses `elapsed` [s] apart, `since` [s] after the first. Over a short time: constant
// acceleration, a good model of a hand. Over a longer one: its mean velocity.
RigidMotion on_the_way(const RigidMotion& before, const RigidMotion& now, double elapsed, double since) {
  const Vector6 mean = now.velocity;
  const Vector6 gains = elapsed < kEvenWay ? Vector6(2.0 / elapsed * (mean - before.velocity)) : Vector6::Zero();
  const Vector6 begin = mean - 0.5 * elapsed * gains;
  const Vector6 way = since * begin + 0.5 * since * since * gains;
  RigidMotion out;
  out.pose.position = before.pose.position + linear(way);
  out.pose.rotation = glm::normalize(rotation_of(angular(way)) * before.pose.rotation);
  out.velocity = begin + since * gains;
  return out;
}

// Catches the handle up with missed ticks, along the device's path. A handle that moved for one tick only would stay
// behind, and its coupling would pull the hand in free air. A few ticks are caught up exactly. Many are caught up in a
// few long steps by the linear model, since the contacts' matrices are not prepared for them.
void catch_up(ToolTouchState& tool, const HandleModel& model, const Handle6& settings, const RigidMotion& before,
              double missed, Tick tick) {
  const auto ticks = static_cast<int>(std::lround(missed / tick.dt));
  const int steps = ticks <= kMostCaughtUp ? ticks : std::min(ticks, kLongCatchUps);
  if (steps <= 0) return;
  const RigidMotion now = tool.sensed;
  const double elapsed = missed + tick.dt;
  int done = 0;
  for (int i = 0; i < steps; ++i) {
    const int count = (ticks - done) / (steps - i);
    const double since = tick.dt * (1 + done);
    const Tick part{tick.index, count * tick.dt, tick.time - elapsed + since};
    tool.sensed = on_the_way(before, now, elapsed, since);
    if (count > 1 && tool.used == ToolForce::kContacts) use(tool, ToolForce::kLinear);
    step(tool, model, settings, part);
    done += count;
    for (int k = 0; k < count; ++k) tool.path.push({part.time + (k + 1) * tick.dt, tool.handle.velocity});
  }
  tool.sensed = now;  // at its mean velocity: extrapolation from one late tick to the next would oscillate
}

void feel(World& world, ToolTouchState& tool, Tick tick) {
  const Handle6& settings = settings_of(world, tool);
  tool.device_wrench.setZero();
  const RigidMotion before = tool.sensed;
  double missed = 0.0;
  const bool sensing = sense(tool, world.registry.get<HapticDevice>(tool.device), tick, missed);
  if (tool.model.acquire()) adopt(tool, tool.model.read());
  const HandleModel& model = tool.model.read();
  if (tool.is_probe && sensing && tool.set_backs == 0) tool.set_backs = 1;  // moves its shell to its device
  if (stands_aside(world, tool)) {
    if (sensing) feel_pull(world, tool, model, settings, tick);
  } else if (tool.placed() && sensing) {
    if (tool.wanted == ToolForce::kHeld) {
      hold(tool, model, tick);
    } else {
      catch_up(tool, model, settings, before, missed, tick);
      // Before the step, so that device and handle are of the same time: a handle one tick ahead would push a moving
      // hand on, by k v dt.
      pull_device(tool, model, -coupling_force(settings, tool.handle, tool.sensed.at(model.centre)).wrench);
      step(tool, model, settings, tick);
    }
    if (!motion_is_finite(tool.handle)) {
      world.dropped |= kDroppedNonFinite;
      unplace(tool, HandleState::kNew);  // a non-finite model must not enter the handle
    } else if (got_away(tool, model)) {
      world.dropped |= kDroppedSetBack;
      ++tool.set_backs;
      unplace(tool, HandleState::kSetBack);
    }
  } else {  // without a device the handle stays at its pose
    tool.handle.velocity.setZero();
    tool.gained.setZero();
    tool.sensed.velocity.setZero();
  }
  send_to_soft_clock(world, tool, tick);
}

}  // namespace

void tool_feedback(World& world, Tick tick) {
  if (!world.tools) return;
  for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools) feel(world, *tool, tick);
}

}  // namespace pliant
