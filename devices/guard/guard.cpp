#include "devices/guard/guard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "devices/guard/turn_between.h"

namespace pliant {
namespace {

bool finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool finite(const DeviceWrench& wrench) {
  return finite(wrench.force) && finite(wrench.torque) && std::isfinite(wrench.grip);
}

// Clamps the norm, not each axis, so that the direction is kept.
dvec3 clamp_norm(dvec3 v, double most) {
  const double size = length(v);
  return size > most ? v * (most / size) : v;
}

// 0: unspecified. A parameter can only lower a limit.
double lowest(double device, double other) {
  return device > 0.0 && other > 0.0 ? std::min(device, other) : std::max(device, other);
}

// Rising force is slew-limited; the part of the last force that is no longer wanted is removed at once.
dvec3 slewed(dvec3 last, dvec3 wanted, double most) {
  const double size = length(last);
  if (size > 0.0) last *= std::clamp(dot(wanted, last) / (size * size), 0.0, 1.0);
  return last + clamp_norm(wanted - last, most);
}

}  // namespace

double stable_stiffness(const DeviceCapabilities& can, double rate, double model_damping) {
  if (!(can.damping > 0.0) || !(rate > 0.0)) return can.max_stiffness;
  const double hold = 0.5 / rate + std::max(0.0, can.latency);
  const double passive = std::max(0.0, can.damping - std::abs(model_damping)) / hold;
  return can.max_stiffness > 0.0 ? std::min(can.max_stiffness, passive) : passive;
}

Guard::Guard(const DeviceCapabilities& can, const GuardParameters& parameters) : can_(can), parameters_(parameters) {
  losses_.fill(-1e9);
}

void Guard::to(DeviceState state, DeviceCause cause, double now) {
  report_.kept[report_.transitions % DeviceReport::kKept] = {report_.state, state, cause, now, length(last_.force)};
  ++report_.transitions;
  report_.state = state;
  report_.cause = cause;
  if (state != DeviceState::kActive) send_nothing();
  if (state == DeviceState::kTripped || state == DeviceState::kDisconnected) make_safe_ = true;
  if (state == DeviceState::kIdle) fresh_since_ = now;
}

void Guard::send_nothing() {
  forfeit(share_ * (pushed_.energy() + twisted_.energy()));
  credited_ = 0.0;
  last_ = report_.sent = {};
  report_.force = ramp_ = slow_speed_ = share_ = most_ = most_turn_ = 0.0;
  carried_ = dvec3(0);
  fade_ = 1.0;
  push_.forget();
  twist_.forget();
  pushed_.forget();
  twisted_.forget();
}

void Guard::trip(DeviceCause cause, double now) {
  if (running()) to(DeviceState::kTripped, cause, now);
}

// Called at most once per loss: afterwards the state is armed. A loss while no force is rendered counts too.
void Guard::lose(DeviceCause cause, double now) {
  if (state() != DeviceState::kActive) return;
  losses_[loss_++ % kMostLosses] = now;
  const double first = *std::min_element(losses_.begin(), losses_.end());
  if (now - first < 1.0)
    trip(DeviceCause::kUnsteady, now);
  else
    to(DeviceState::kArmed, cause, now);
}

bool Guard::take_make_safe() {
  return std::exchange(make_safe_, false);
}

bool Guard::fresh(double now) const {
  const double holds = can_.rate > 0.0 ? std::max(kStaleAfter, 2.5 / can_.rate) : kStaleAfter;
  return placed_ && ready_ && now - sensed_at_ <= holds;
}

// Whether the sample's pose is valid; otherwise records the cause.
bool Guard::sound(const DeviceSample& sample, double now) {
  DeviceCause cause = DeviceCause::kNone;
  const double at = sample.time > 0.0 ? sample.time : now;
  const double far = dot(can_.workspace, can_.workspace) > 0.0 ? kFarOut * length(can_.workspace) : kFarthest;
  const double unit = can_.senses_rotation ? glm::length(sample.rotation) : 1.0;
  if (!can_.senses_position) {
    cause = std::isfinite(sample.grip) && std::isfinite(at) ? DeviceCause::kNone : DeviceCause::kNotANumber;
  } else if (!finite(sample.position) || !(std::abs(unit - 1.0) < kUnitWithin) || !std::isfinite(at)) {
    cause = DeviceCause::kNotANumber;
  } else if (at < sensed_at_ || at > now + kStaleAfter) {
    cause = DeviceCause::kTimeBack;
  } else if (length(sample.position) > far) {
    trip(DeviceCause::kOutside, now);
    return false;
  } else if (placed_) {
    const double since = std::max(at - sensed_at_, can_.rate > 0.0 ? 0.5 / can_.rate : 1e-4);
    if (length(sample.position - position_) > kFastestHand * since) {
      placed_ = false;  // the next sample restarts from its pose
      cause = DeviceCause::kJumped;
    }
  }
  if (cause == DeviceCause::kNone) return true;
  moves_ = false;
  lose(cause, now);
  return false;
}

void Guard::take(const DeviceSample& sample, double at) {
  const dquat rotation = can_.senses_rotation ? glm::normalize(sample.rotation) : rotation_;
  const bool same = placed_ && sample.position == position_ && rotation == rotation_ && sample.grip == 0.0;
  if (!same) changed_at_ = at;
  const double since = at - sensed_at_;
  if (placed_ && moves_ && since > 0.0) {
    const double share = 1.0 - std::exp(-since / kVelocityTime);
    velocity_ += share * ((sample.position - position_) / since - velocity_);
    spin_ += share * (turn_between(rotation_, rotation) / since - spin_);
  } else if (!(placed_ && moves_)) {
    velocity_ = spin_ = dvec3(0);
  }
  if (placed_ && moves_) {
    way_ = sample.position - position_;
    turn_ = turn_between(rotation_, rotation);
  }
  position_ = sample.position;
  rotation_ = rotation;
  sensed_at_ = at;
  placed_ = moves_ = heard_ = true;
}

void Guard::sense(const DeviceSample* sample, double now, const GuardOrders& orders) {
  dt_ = stepped_ ? now - now_ : 0.0;
  way_ = turn_ = dvec3(0);
  heard_ = false;
  if (!(dt_ >= 0.0)) {  // the clock itself failed
    lose(DeviceCause::kTimeBack, now);
    dt_ = 0.0;
    placed_ = false;
    sensed_at_ = std::min(sensed_at_, now);
  }
  const double gap = can_.rate > 0.0 ? std::max(kStaleAfter, 2.5 / can_.rate) : kStaleAfter;
  if (orders.suspended)
    trip(DeviceCause::kSuspended, now);
  else if (dt_ > kLatchAfter)
    trip(DeviceCause::kClockGap, now);
  else if (dt_ > gap)
    lose(DeviceCause::kClockGap, now);
  stepped_ = true;
  now_ = now;
  follow_orders(orders, now);
  if (sample) {
    if (sample->ready != ready_) {
      ready_ = sample->ready;
      placed_ = false;
      if (!ready_) lose(DeviceCause::kNotReady, now);
    }
    buttons_ = sample->buttons;
    warnings_ = sample->warnings;
    if (ready_ && sound(*sample, now)) take(*sample, sample->time > 0.0 ? std::min(sample->time, now) : now);
  }
  watch(now);
}

// Faults detected from the pose alone.
void Guard::watch(double now) {
  if (!fresh(now)) {
    fresh_since_ = now;
    moves_ = false;
    if (state() == DeviceState::kIdle) to(DeviceState::kDisconnected, DeviceCause::kNoSample, now);
    return;
  }
  if (state() == DeviceState::kDisconnected) to(DeviceState::kIdle, DeviceCause::kConnected, now);
  if (state() != DeviceState::kActive) return;
  double fastest = lowest(can_.max_velocity, parameters_.max_velocity);
  if (!(fastest > 0.0)) fastest = kDefaultVelocity;
  if (length(velocity_) > fastest) trip(DeviceCause::kTooFast, now);
  // A hand that is perfectly still looks the same. Therefore the force fades out; a motion of a single count restores
  // it.
  const double still = now - changed_at_;
  if (still > kFrozenAfter + kFrozenFade && fade_ <= 0.0)
    lose(DeviceCause::kFrozen, now);
  else if (still > kFrozenAfter && (fade_ < 1.0 || length(last_.force) > kEngageForce))
    fade_ = std::max(0.0, fade_ - dt_ / kFrozenFade);
  else if (!(warnings_ & kDeviceBatteryLow))
    fade_ = parameters_.ramp > 0.0 ? std::min(1.0, fade_ + dt_ / parameters_.ramp) : 1.0;
}

void Guard::follow_orders(const GuardOrders& orders, double now) {
  if (orders.disarm || orders.arm) disarmed_ = orders.disarm;
  if (orders.failed) trip(DeviceCause::kDriverFailed, now);
  if (orders.stop && state() != DeviceState::kTripped)
    to(DeviceState::kTripped, DeviceCause::kEmergencyStop, now);
  else if (orders.disarm && running())
    to(DeviceState::kIdle, DeviceCause::kDisarmed, now);
  else if (orders.arm && !orders.stop && (state() == DeviceState::kIdle || state() == DeviceState::kTripped)) {
    if (!fresh(now)) return;
    losses_.fill(-1e9);
    energy_ = {};
    changed_at_ = now;
    missing_ = false;
    to(DeviceState::kArmed, DeviceCause::kArmedByHand, now);
  }
}

// A missing sample or model removes the force at once, and trips if it lasts.
void Guard::decide(const GuardInput& wanted, const GuardOrders& orders, double now) {
  if (orders.let_go) {
    missing_ = false;
    if (state() == DeviceState::kActive) to(DeviceState::kArmed, DeviceCause::kLetGo, now);
    return;
  }
  const bool modelled = wanted.known && wanted.age <= kModelHolds;
  if (!fresh(now) || !modelled) {
    if (!missing_) missing_since_ = fresh(now) ? now - wanted.age : std::min(now, sensed_at_);
    missing_ = true;
    lose(fresh(now) ? DeviceCause::kModelStale : ready_ ? DeviceCause::kNoSample : DeviceCause::kNotReady, now);
    if ((wanted.known || !fresh(now)) && now - missing_since_ > kLatchAfter)
      trip(fresh(now) ? DeviceCause::kModelLost : DeviceCause::kLost, now);
    return;
  }
  missing_ = false;
  const bool held = (buttons_ & parameters_.dead_man) != 0;
  if (state() == DeviceState::kIdle && parameters_.arming == Arming::kAutomatic && !disarmed_ &&
      now - fresh_since_ >= kSettleTime)
    to(DeviceState::kArmed, DeviceCause::kArmedByItself, now);
  if (state() == DeviceState::kActive) {
    if (!finite(wanted.wrench) || !finite(wanted.weight) || !finite(wanted.velocity)) lose(DeviceCause::kBadForce, now);
    if (parameters_.dead_man != 0 && !held && state() == DeviceState::kActive)
      to(DeviceState::kArmed, DeviceCause::kDeadManReleased, now);
    return;
  }
  if (state() != DeviceState::kArmed || !finite(wanted.wrench) || (warnings_ & kDeviceBatteryLow)) return;
  if (parameters_.dead_man != 0) {
    if (held) to(DeviceState::kActive, DeviceCause::kDeadManHeld, now);
  } else if (!wanted.easing && length(wanted.wrench.force - wanted.weight) < kEngageForce &&
             length(wanted.wrench.torque) < kGateTorque) {
    to(DeviceState::kActive, DeviceCause::kSmallForce, now);
  }
  if (state() == DeviceState::kActive) changed_at_ = now;
}

double Guard::force_limit(const GuardInput& wanted) const {
  const double most = lowest(lowest(can_.max_force, parameters_.max_force), wanted.max_force);
  return most > 0.0 ? most : std::numeric_limits<double>::infinity();
}
double Guard::torque_limit(const GuardInput& wanted) const {
  const double most = lowest(lowest(can_.max_torque, parameters_.max_torque), wanted.max_torque);
  return most > 0.0 ? most : std::numeric_limits<double>::infinity();
}

// Speed increases against a large force, faster than a pushing hand could cause.
bool Guard::runs_away(const GuardInput& wanted, double dt) {
  const double size = length(last_.force), most = force_limit(wanted);
  const double against = size > 0.0 ? -dot(velocity_ - wanted.velocity, last_.force) / size : 0.0;
  if (size < kRunawayShare * std::min(most, kUsualForce)) {
    slow_speed_ = against;
    return false;
  }
  slow_speed_ += (1.0 - std::exp(-dt / kRunawayTime)) * (against - slow_speed_);
  return against > kRunawayGain && against - slow_speed_ > kRunawayGain;
}

// A limit that is raised during contact rises with the same ramp as a force.
double Guard::risen_slowly(double before, double most, double dt) const {
  const bool rises = before > 0.0 && most > before && std::isfinite(most) && parameters_.ramp > 0.0;
  return rises ? std::min(most, before + most * dt / parameters_.ramp) : most;
}

// If a larger share of the wanted force is released than in the last period, the hand has worked only against the
// smaller one. If the limit is raised, the hand has stored at least the energy above it under the lower limit.
void Guard::credit(const GuardInput& wanted, double share, double most) {
  const dvec3 whole = wanted.wrench.force - wanted.weight;
  pushed_.follow(clamp_norm(whole, most), heard_ ? way_ - carried_ : dvec3(0), wanted.stiffness);
  twisted_.follow(wanted.wrench.torque, turn_, wanted.turning_stiffness);
  if (whole == dvec3(0) && wanted.wrench.torque == dvec3(0)) {
    forfeit(credited_);
    credited_ = 0.0;
  }
  double gained = std::max(0.0, share - share_) * (pushed_.energy() + twisted_.energy());
  if (most_ > 0.0 && most > most_) {
    const double raised = std::max(0.0, std::min(most, share * length(whole)) - most_);
    const double more = raised * pushed_.energy() / most_;
    pushed_.raise(more);
    gained += more;
  } else if (most_ > most) {
    const double before = std::min(most_, share * length(whole));
    if (before > most) {
      const double less = (1.0 - most / before) * pushed_.energy();
      pushed_.raise(-less);
      forfeit(less);
    }
  }
  if (gained > 0.0) {  // and is a number
    energy_.work -= gained;
    credited_ += gained;
  }
  share_ = share;
}

// Energy that the hand can no longer get back: the force that held it was taken away, or the contact to which it was
// credited is over. Otherwise a force that goes and comes would be credited each time. Never below an even account.
void Guard::forfeit(double energy) {
  energy_.work += std::min(std::max(0.0, -energy_.work), energy);  // all of it if `energy` is not a number
}

DeviceWrench Guard::limited(const GuardInput& wanted, double dt) {
  ramp_ = parameters_.ramp > 0.0 ? std::min(1.0, ramp_ + dt / parameters_.ramp) : 1.0;
  if (warnings_ & kDeviceBatteryLow) fade_ = std::max(0.0, fade_ - dt / kFadeTime);
  const double gain = ramp_ * fade_;
  DeviceWrench wrench = wanted.wrench;
  double force_most = force_limit(wanted), torque_most = torque_limit(wanted);

  // Thermal model: the mean square of the force relative to the continuous limit.
  const double bears = can_.continuous_force;
  if (bears > 0.0 && std::isfinite(force_most)) {
    const double square = dot(last_.force, last_.force) / (bears * bears);
    heat_ += (1.0 - std::exp(-dt / kThermalTime)) * (square - heat_);
    const double cool = std::clamp((1.0 - heat_) / 0.2, 0.0, 1.0);
    const double warm = warnings_ & kDeviceWarm ? 0.0 : cool;
    force_most = std::min(force_most, bears + warm * std::max(0.0, force_most - bears));
    report_.max_force = force_most;
    report_.heat = heat_;
  } else if (warnings_ & kDeviceWarm) {
    report_.max_force = force_most *= kWarmShare;
  }
  if (warnings_ & kDeviceWarm) torque_most *= kWarmShare;
  carried_ += wanted.velocity * dt;
  force_most = risen_slowly(most_, force_most, dt);
  torque_most = risen_slowly(most_turn_, torque_most, dt);
  credit(wanted, gain, force_most);
  most_turn_ = torque_most;
  most_ = force_most;
  if (std::isfinite(force_most)) report_.max_force = force_most;

  wrench.force = can_.renders_force ? clamp_norm(gain * wrench.force, force_most) : dvec3(0);
  wrench.torque = can_.renders_torque ? clamp_norm(gain * wrench.torque, torque_most) : dvec3(0);
  wrench.grip = can_.renders_grip ? std::max(0.0, gain * wrench.grip) : 0.0;
  if (can_.max_grip > 0.0) wrench.grip = std::min(wrench.grip, can_.max_grip);
  const dvec3 weight = clamp_norm(gain * wanted.weight, length(wrench.force));

  // A brake cannot push: no force along the motion, and none that would start a motion in its last direction.
  const double speed = length(velocity_ - wanted.velocity);
  if (can_.resists_only) {
    if (speed > 0.0) {
      const dvec3 along = (velocity_ - wanted.velocity) / speed;
      wrench.force -= std::max(0.0, dot(wrench.force, along)) * along;
    } else {
      wrench.force = dvec3(0);
    }
  }
  // A late period counts as a normal one: otherwise the missed time would allow a step.
  const double slew = parameters_.slew * (can_.rate > 0.0 ? std::min(dt, 1.0 / can_.rate) : dt);
  wrench.force = slewed(last_.force, wrench.force, slew);
  wrench.torque = slewed(last_.torque, wrench.torque, kGuardLever * slew);

  const dvec3 way = heard_ ? way_ - carried_ : dvec3(0);
  if (heard_) carried_ = dvec3(0);
  const EnergyAccount before = energy_;
  wrench.force =
      push_.damp(before, wrench.force, weight, way, force_most, kSlowHand * dt, wanted.stiffness, kUsualSpring);
  wrench.torque = twist_.damp(before, wrench.torque, dvec3(0), turn_, torque_most, kSlowTurn * dt,
                              wanted.turning_stiffness, kUsualTurnSpring);
  if (can_.resists_only && speed > 0.0) {
    const dvec3 along = (velocity_ - wanted.velocity) / speed;
    wrench.force -= std::max(0.0, dot(wrench.force, along)) * along;
  }
  push_.book(energy_, wrench.force - weight);
  twist_.book(energy_, wrench.torque);
  return wrench;
}

DeviceWrench Guard::release(const GuardInput& wanted, double now, const GuardOrders& orders) {
  report_.wanted = wanted.known ? wanted.wrench : DeviceWrench{};
  const double most = force_limit(wanted);
  report_.max_force = std::isfinite(most) ? most : 0.0;
  decide(wanted, orders, now);
  if (state() == DeviceState::kActive && runs_away(wanted, dt_)) trip(DeviceCause::kRunaway, now);
  if (state() != DeviceState::kActive) {
    if (heat_ > 0.0) report_.heat = heat_ *= std::exp(-dt_ / kThermalTime);
    return {};
  }
  const DeviceWrench wrench = limited(wanted, dt_);
  if (energy_.work > kMostGiven + kPassivityShare * energy_.stored) {
    trip(DeviceCause::kGaveEnergy, now);
    return {};
  }
  if (!finite(wrench)) {  // invalid, and must not be rendered
    trip(DeviceCause::kBadForce, now);
    return {};
  }
  last_ = report_.sent = wrench;
  report_.force = length(wrench.force);
  if (fade_ <= 0.0 && (warnings_ & kDeviceBatteryLow)) {
    trip(DeviceCause::kBatteryLow, now);
    return {};
  }
  return wrench;
}

void Guard::close(double now) {
  if (state() != DeviceState::kDisconnected) to(DeviceState::kDisconnected, DeviceCause::kClosed, now);
  placed_ = false;
}

}  // namespace pliant
