// The force that a device may render: when it may begin and must end, and the limits of its size, rise, heat and
// energy.
#include <algorithm>
#include <cmath>
#include <limits>

#include "devices/guard/bounds.h"
#include "devices/guard/guard.h"

namespace pliant {
namespace {

// Rising force is slew-limited; the part of the last force that is no longer wanted is removed at once.
dvec3 slewed(dvec3 last, dvec3 wanted, double most) {
  const double size = length(last);
  if (size > 0.0) last *= std::clamp(dot(wanted, last) / (size * size), 0.0, 1.0);
  return last + clamp_norm(wanted - last, most);
}

}  // namespace

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

}  // namespace pliant
