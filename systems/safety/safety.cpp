#include "systems/safety/safety.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

bool finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Clamps the norm, never each axis: the direction must be kept. A NaN limit gives zero force.
dvec3 clamp_norm(dvec3 v, double most) {
  if (!(most > 0.0)) return dvec3(0);
  const double size = length(v);
  return size > most ? v * (most / size) : v;
}

// Only devices that sense a person can be stale; scripted motion has no age.
bool stale(const HapticDevice& device, double now) {
  return (device.driver == DriverKind::kExternal || device.driver == DriverKind::kMouse) &&
         now - device.sensed_at > kStaleAfter;
}

// Largest component along the motion that can be brought to zero within the slew limit without returning more than
// `budget` [J]. The hand moves by `step` [m] per tick; the force falls by at most `fall` [N] per tick. From p the
// trapezoids sum to p * step if one tick suffices, else to at most (p/2 + p^2/(2 fall) + fall/8) * step.
double stoppable(double budget, double step, double fall) {
  const double mean = budget / step;
  const double over_ticks = fall > 0 ? fall * (std::sqrt(2 * mean / fall) - 0.5) : 0.0;
  return std::max(std::min(mean, fall), over_ticks);
}

// Passivity controller: reduces the component of the force along the motion where the hand would get more energy than
// it gave. It opposes the motion only to dissipate excess energy, in proportion to the speed of a slow hand. It never
// exceeds the wanted force: in free space there is no drag. Components across the motion are unchanged.
dvec3 damp_excess(const SafetyState& state, const SafetyLimits& limits, dvec3 wanted, dvec3 weight, dvec3 dx,
                  double dt) {
  const double way = length(dx);
  if (!(way > 0.0)) return wanted;
  const dvec3 along = dx / way;
  const double step = kPassivityReserve * way;
  const double given = state.work + 0.5 * dot(state.force - state.weight, dx);
  // The trapezoid of a spring that the hand leaves in the middle of a step has an error of up to |df| step / 8, and the
  // same on entry. This sampling error is not attributed to the law.
  const double sampling = 0.25 * length(wanted - weight - state.wanted) * way;
  const double budget = kPassivityShare * state.stored + kPassivityFloor + sampling - given;
  const double beside = dot(wanted - weight, along), total = dot(wanted, along), size = length(wanted);
  double most = 0.0;
  if (budget > 0) {
    most = stoppable(budget, step, std::max(limits.slew, limits.fall) * dt);
  } else {
    most = -std::min(-budget / step, size * std::min(1.0, way / (limits.slow * dt)));
  }
  // The force added against the motion must not bring the whole above the device's limit.
  const double across = std::max(0.0, size * size - total * total);
  const double room = total + std::sqrt(std::max(0.0, limits.force * limits.force - across));
  const double reduction = std::min({beside - most, size, room});
  return reduction > 0 ? wanted - reduction * along : wanted;
}

// Removes the part of `force` that is no longer in `wanted`, at most `most`. Only along the force, so that no new force
// appears.
dvec3 let_fall(dvec3 force, dvec3 wanted, double most) {
  const double size = length(force);
  if (!(size > 0.0)) return force;
  const double kept = std::max(0.0, dot(wanted, force) / size);
  return kept < size ? force * (std::max(kept, size - most) / size) : force;
}

// The smaller of a level's limit and a driver's; 0: none given.
double smaller(double level, double driver) {
  return driver > 0.0 ? std::min(level, driver) : level;
}

void book(SafetyState& state, dvec3 force, dvec3 weight, dvec3 dx) {
  state.work += 0.5 * dot(state.force - state.weight + force - weight, dx);
  state.stored = std::max(state.stored, -state.work);
}

// [s] Length of the ticks before this one that could not begin.
double missed_before(SafetyState& state, double now, double dt) {
  const double missed = state.ticked ? now - state.ticked_at - dt : 0.0;
  state.ticked = true;
  state.ticked_at = now;
  return missed > 0.5 * dt ? missed : 0.0;
}

// After `missed` [s]: `force` has risen meanwhile; it fades in from the last force sent. The hand's work is counted as
// if the force had been present, so that the rise creates no energy deficit.
void ease_in(SafetyState& state, dvec3 force, dvec3 weight, dvec3 dx, double missed) {
  const double size = length(force), has = length(state.force);
  if (missed < kEasedFrom || !(size > has)) return;
  state.eased = has / size;
  state.easing = (1.0 - state.eased) / kEase;
  state.work += std::min(0.0, 0.5 * (1.0 - state.eased) * dot(force - weight, dx));
}

// Counts a difference of `missing` [N] from what was wanted, `size` [N].
void count(SafetyTally& tally, SafetyLimit limit, double missing, double size) {
  if (missing > kCountedForce && missing > kCountedShare * size) tally.add(limit, std::min(1.0, missing / size));
}

}  // namespace

bool jumps(const SafetyState& state, const HapticDevice& device, const SafetyLimits& limits, dvec3 position,
           double dt) {
  const double elapsed = std::max(dt, device.sensed_at - state.sensed_at);
  return state.placed && length(position / limits.scale - state.position) > limits.fastest * elapsed * (1 + 1e-9);
}

bool plausible_position(dvec3 position) {
  return finite(position) && length(position) < kFarthest;
}

bool plausible_rotation(dquat rotation) {
  const double size = length(rotation);
  return std::abs(size - 1.0) < kUnitWithin;  // false for NaN
}

SafetyLimits force_limits(const HapticDevice& device) {
  const DeviceCapabilities& can = device.can;
  SafetyLimits limits;
  limits.scale = device.workspace;
  limits.force = can.renders_force ? smaller(device.max_force, can.max_force) : 0.0;
  limits.stiffness = device.max_stiffness * limits.scale;  // in the driver's metres: systems/device/softening.h
  limits.slew = device.max_slew;
  return limits;
}

SafetyLimits torque_limits(const HapticDevice& device, const HandleParameters& handle) {
  const auto of_torque = [&](double force) { return force * handle.max_torque / std::max(handle.max_force, 1e-9); };
  SafetyLimits limits;
  limits.force = device.can.renders_torque ? smaller(handle.max_torque, device.can.max_torque) : 0.0;
  limits.slew = of_torque(device.max_slew);
  limits.fall = of_torque(kLeastFall);
  limits.slow = kSlowTurn;
  limits.fastest = kFastestTurn;
  return limits;
}

dvec3 with_own(SafetyState& state, SafetyLimits& limits, dvec3 pressed, double dt) {
  if (state.added == dvec3(0) && state.own == dvec3(0)) return pressed;
  state.added_share = state.engaged ? std::min(1.0, state.added_share + dt / kWeightTime) : 0.0;
  const dvec3 way = state.added_share * state.added - state.own;
  const dvec3 step = state.engaged ? clamp_norm(way, limits.slew * dt) : way;
  limits.own_rise = length(step);
  state.own += step;
  return pressed + state.own;
}

void SafetyTally::add(SafetyLimit limit, double share) {
  LimitCount& count = counts[static_cast<std::size_t>(limit)];
  ++count.ticks;
  count.largest_share = std::max(count.largest_share, share);
  now = static_cast<std::uint8_t>(now | bit(limit));
}

SafetyResult make_safe(SafetyState& state, const HapticDevice& device, dvec3 wanted, dvec3 position, double now,
                       double dt) {
  return make_safe(state, device, force_limits(device), wanted, position, now, dt);
}

SafetyResult make_safe(SafetyState& state, const HapticDevice& device, const SafetyLimits& limits, dvec3 wanted,
                       dvec3 position, double now, double dt) {
  SafetyResult result;
  state.tally.now = 0;
  const double missed = missed_before(state, now, dt);
  const dvec3 at = position / limits.scale;
  if (!finite(wanted) || !finite(limits.weight) || !finite(limits.carried) || !plausible_position(position) ||
      !plausible_position(at)) {
    result.event = SafetyEvent::kNonFinite;
  } else if (device.status != DeviceStatus::kReady || stale(device, now)) {
    result.event = device.status == DeviceStatus::kReady ? SafetyEvent::kStale : SafetyEvent::kNone;
  } else {
    const bool jumped = limits.jumped || jumps(state, device, limits, position, dt);
    const dvec3 dx = state.placed && !jumped ? at - state.position - limits.carried / limits.scale : dvec3(0);
    if (jumped) {
      result.event = SafetyEvent::kJumped;
      state.engaged = false;
    } else if (!state.engaged) {
      state.hidden = length(wanted - limits.weight) < length(wanted) ? 1.0 : 0.0;
      state.engaged = length(wanted - state.hidden * limits.weight) < kEngageForce;
    }
    const dvec3 felt = wanted - state.hidden * limits.weight;
    dvec3 force(0), weight(0);
    if (state.engaged) {
      force = clamp_norm(felt, limits.force);
      weight = clamp_norm((1.0 - state.hidden) * limits.weight, limits.force);
      state.hidden = std::max(0.0, state.hidden - dt / kWeightTime);
      if (length(felt) > limits.force * (1 + 1e-9))
        state.tally.add(SafetyLimit::kClipped, 1.0 - limits.force / length(felt));
    } else {
      count(state.tally, SafetyLimit::kGated, length(felt), length(felt));
    }
    if (missed > 0.0) ease_in(state, force, weight, dx, missed);
    if (state.eased < 1.0) {
      count(state.tally, SafetyLimit::kSlewed, (1.0 - state.eased) * length(force), length(force));
      force *= state.eased;
      weight *= state.eased;
      state.eased = std::min(1.0, state.eased + state.easing * dt);
    }
    const dvec3 passive = damp_excess(state, limits, force, weight, dx, dt);
    state.wanted = force - weight;
    count(state.tally, SafetyLimit::kWithheld, length(force - passive), length(force));
    double most = limits.slew * dt;
    if (limits.stiffness > 0) {
      // The force may grow with displacement no faster than the device can render stably; it may always fall. The
      // fade-in of a weight is not a response to displacement.
      const double rise = limits.stiffness * length(dx) + length(weight - state.weight) + limits.own_rise;
      if (length(passive) > length(state.force)) most = std::min(most, rise);
    }
    dvec3 last = state.force;
    if (limits.fall > limits.slew) {
      last = let_fall(state.force, passive, limits.fall * dt);
      most = std::min(most, limits.fall * dt - length(state.force - last));  // the rest is left for the rise
    }
    force = last + clamp_norm(passive - last, most);
    count(state.tally, SafetyLimit::kSlewed, length(passive - force), std::max(length(passive), length(force)));
    book(state, force, weight, dx);
    result.force = force;
    state.position = at;
    state.sensed_at = device.sensed_at;
    state.placed = true;
    state.force = result.force;
    state.weight = weight;
    return result;
  }
  // Unknown state: zero force at once, and the gate must be passed again. The work account is kept.
  state.engaged = false;
  state.placed = false;
  state.eased = 1.0;
  state.force = state.weight = state.wanted = state.own = dvec3(0);
  return result;
}

}  // namespace pliant
