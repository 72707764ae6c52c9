// State of a device, from its samples, orders and faults.
#include "devices/guard/guard.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "devices/guard/bounds.h"
#include "devices/guard/turn_between.h"

namespace pliant {

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

void Guard::close(double now) {
  if (state() != DeviceState::kDisconnected) to(DeviceState::kDisconnected, DeviceCause::kClosed, now);
  placed_ = false;
}

}  // namespace pliant
