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

// [N] What of `wanted`, beside the weight, is kept back: outwards it is at most the force of a spring that holds
// `budget`. Inwards, or at rest, it comes back as the spring is pressed; nothing is kept back of a force that has never
// been too large.
double kept_back(const SafetyState& state, const SafetyLimits& limits, dvec3 wanted, dvec3 dx, double budget) {
  const double size = length(wanted), way = length(dx);
  if (!(size > 0.0)) return 0.0;
  const double spring = limits.touched > 0.0 ? kSpentSpring * limits.touched : limits.spring;
  const double left = std::sqrt(2.0 * spring * std::max(0.0, budget)), out = way > 0.0 ? dot(wanted, dx) / way : 0.0;
  if (out > 0.0) return std::max(0.0, out - left);
  const double back = std::max(left, length(state.force - state.weight) + spring * way);
  return std::min(state.kept_back, std::max(0.0, size - back));
}

// Reduces the component of the force along the motion where the hand would get more energy than it gave. Beyond zero
// only to take out what was given too much, in proportion to the speed of a slow hand, and never by more than the
// wanted force: in free space nothing drags. Components across the motion stay.
dvec3 damp_excess(SafetyState& state, const SafetyLimits& limits, dvec3 wanted, dvec3 weight, dvec3 dx, double dt) {
  const double way = length(dx);
  const dvec3 last = state.force - state.weight, change = wanted - weight - state.wanted;
  const double falls = std::max(0.0, -dot(change, dx));  // [J] the law's own change over the way
  const double given = state.work + dot(last, dx) - 0.5 * falls;
  // The trapezoid of a spring that the hand leaves in the middle of a step is off by up to |df| step / 8, and by as
  // much where the hand came in: what sampling does is not taken for the law's.
  const double sampling = 0.25 * length(change) * way;
  const double budget = kPassivityShare * state.stored + kPassivityFloor + sampling - given;
  state.kept_back = kept_back(state, limits, wanted - weight, dx, budget);
  if (state.kept_back > 0.0) {  // across the motion nothing is missing
    const dvec3 beside = wanted - weight;
    wanted -=
        dot(beside, dx) > 0.0 ? state.kept_back * dx / way : beside * std::min(1.0, state.kept_back / length(beside));
  }
  if (!(way > 0.0)) return wanted;
  const dvec3 along = dx / way;
  const double step = kPassivityReserve * way;
  const double beside = dot(wanted - weight, along), total = dot(wanted, along), size = length(wanted);
  double most = 0.0;
  if (budget > 0) {
    // Of a law that falls along the way, half a step's force is not given.
    const double less = falls > 0.0 ? 0.5 * std::max(0.0, beside) * way : 0.0;
    most = stoppable(budget + less, step, std::max(limits.slew, limits.fall) * dt);
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

// `force` as a spring of `stiffness` at most, as long as more is wanted: in and out. One that rose by it and fell as
// the stiffer law does would push the hand out with more than it gave.
dvec3 no_stiffer(const SafetyState& state, double stiffness, dvec3 force, dvec3 weight, dvec3 dx) {
  const dvec3 beside = force - weight;
  const double size = length(beside), last = length(state.force - state.weight);
  if (!(size > last * (1 + 1e-9))) return force;
  const double allowed = std::max(0.0, last - stiffness * dot(dx, beside) / size);
  return allowed < size ? weight + beside * (allowed / size) : force;
}

// [N] The limit of the force: one that is raised under a hand comes in over kRaise.
double limit_now(SafetyState& state, const SafetyLimits& limits, double dt) {
  const bool rises = state.engaged && state.most > 0.0 && limits.force > state.most;
  state.most = rises ? std::min(limits.force, state.most + limits.force * dt / kRaise) : limits.force;
  return state.most;
}

// [J] What the hand would have given to a spring of the stiffness that is touched from `before` [N] to `most`, where
// `whole` is wanted. It has gone that way against less; without it a force that is let in would owe the account.
double given_beyond(double touched, double before, double most, double whole) {
  const double force = std::min(most, whole);
  if (!(touched > 0.0) || !(force > before)) return 0.0;
  return (force - before) * (whole - 0.5 * (before + force)) / touched;
}

// Energy that the hand can no longer get back, since its force was taken away: the reverse of given_beyond(), or the
// same contact would be credited again whenever the force comes back. Never more than the account holds.
void forfeit(SafetyState& state, double energy) {
  state.work += std::min(energy, std::max(0.0, -state.work));
}

// Of a level's limit and a driver's, where 0 is: not said.
double smaller(double level, double driver) {
  return driver > 0.0 ? std::min(level, driver) : level;
}

void book(SafetyState& state, dvec3 force, dvec3 weight, dvec3 dx, dvec3 change) {
  const dvec3 last = state.force - state.weight;
  const double wanted = dot(change, dx), sent = dot(force - weight - last, dx);
  state.work += dot(last, dx) + 0.5 * (wanted < 0.0 ? std::max(wanted, sent) : std::clamp(sent, 0.0, wanted));
  state.stored = std::max(state.stored, -state.work);
}

// [s] Length of the ticks before this one that could not begin.
double missed_before(SafetyState& state, double now, double dt) {
  const double missed = state.ticked ? now - state.ticked_at - dt : 0.0;
  state.ticked = true;
  state.ticked_at = now;
  return missed > 0.5 * dt ? missed : 0.0;
}

// After `missed` [s]: the law went on, and the way that the hand has gone, `dx`, is counted as if its force had been
// there, so that it owes nothing for the rise; it is counted here alone. What `force` has risen by, from what the
// device still has, comes in over `ease` [s].
void ease_in(SafetyState& state, dvec3 force, dvec3 weight, dvec3& dx, double missed, double ease, double dt) {
  if (missed < kEasedFrom) return;
  state.work += 0.5 * dot(state.wanted + force - weight, dx);
  state.stored = std::max(state.stored, -state.work);
  dx = dvec3(0);
  if (missed + dt > kForceHolds) state.force = state.weight = dvec3(0);
  const double size = length(force), has = length(state.force);
  if (!(size > has)) return;
  state.eased = has / size;
  state.easing = (1.0 - state.eased) / ease;
}

// Counts a difference of `missing` [N] from what was wanted, `size` [N].
void count(SafetyTally& tally, SafetyLimit limit, double missing, double size) {
  if (missing > kCountedForce && missing > kCountedShare * size) tally.add(limit, std::min(1.0, missing / size));
}

// The force that may be felt, and the part of it that is the weight.
struct Share {
  dvec3 force{0}, weight{0};
};

// kNone for a device that is not ready: that is no event, but its state is unknown all the same.
SafetyEvent fault_of(const HapticDevice& device, const SafetyLimits& limits, dvec3 wanted, dvec3 position, double now) {
  if (!finite(wanted) || !finite(limits.weight) || !finite(limits.carried) || !plausible_position(position) ||
      !plausible_position(position / limits.scale))
    return SafetyEvent::kNonFinite;
  return device.status == DeviceStatus::kReady && stale(device, now) ? SafetyEvent::kStale : SafetyEvent::kNone;
}

// Unknown state: zero force at once, and the gate must be passed again. The work account is kept, but for what is
// stored in the contact.
void let_go(SafetyState& state) {
  const double sent = length(state.force - state.weight);
  forfeit(state, given_beyond(state.touched, 0.0, sent, sent));
  state.engaged = false;
  state.placed = false;
  state.eased = 1.0;
  state.kept_back = 0.0;
  state.force = state.weight = state.wanted = state.own = dvec3(0);
}

// The gate: no force until the wanted one is small. Beyond it, the force within the limit.
Share engage(SafetyState& state, const SafetyLimits& limits, dvec3 wanted, bool jumped, double dt) {
  const bool gated = !state.engaged;
  const double before = gated ? 0.0 : state.most, most_now = limit_now(state, limits, dt);
  if (gated && !jumped) {
    state.hidden = length(wanted - limits.weight) < length(wanted) ? 1.0 : 0.0;
    state.engaged = length(wanted - state.hidden * limits.weight) < kEngageForce;
  }
  const dvec3 felt = wanted - state.hidden * limits.weight;
  if (!state.engaged) {
    count(state.tally, SafetyLimit::kGated, length(felt), length(felt));
    return {};
  }
  const Share share{clamp_norm(felt, most_now), clamp_norm((1.0 - state.hidden) * limits.weight, most_now)};
  const double whole = length(felt - (1.0 - state.hidden) * limits.weight);
  state.work -= given_beyond(limits.touched, before, most_now, whole);
  forfeit(state, given_beyond(limits.touched, most_now, before, whole));
  state.hidden = std::max(0.0, state.hidden - dt / kWeightTime);
  if (length(felt) > most_now * (1 + 1e-9)) state.tally.add(SafetyLimit::kClipped, 1.0 - most_now / length(felt));
  return share;
}

// After missed ticks, a share of the force that grows to 1.
Share eased(SafetyState& state, Share share, double dt) {
  count(state.tally, SafetyLimit::kSlewed, (1.0 - state.eased) * length(share.force), length(share.force));
  share.force *= state.eased;
  share.weight *= state.eased;
  state.eased = std::min(1.0, state.eased + state.easing * dt);
  return share;
}

// From the last force towards `passive`: within the limits of slew and, as it grows, of stiffness.
dvec3 slew(const SafetyState& state, const SafetyLimits& limits, dvec3 passive, dvec3 weight, dvec3 dx, double missed,
           double dt) {
  double most = limits.slew * dt;
  dvec3 rendered = passive;
  if (limits.stiffness > 0) {
    // What comes in of a weight is no answer to displacement.
    const double other = length(weight - state.weight) + limits.own_rise;
    if (length(passive) > length(state.force)) most = std::min(most, limits.stiffness * length(dx) + other);
    if (state.own == dvec3(0)) rendered = no_stiffer(state, limits.stiffness, passive, weight, dx);
  }
  dvec3 last = state.force;
  if (missed > 0.0) {  // what is let go has had the time
    last = let_fall(state.force, rendered, std::max(limits.fall, limits.slew) * (missed + dt));
  } else if (limits.fall > limits.slew) {
    last = let_fall(state.force, rendered, limits.fall * dt);
    most = std::min(most, limits.fall * dt - length(state.force - last));  // what comes in has the rest
  }
  return last + clamp_norm(rendered - last, most);
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
  limits.spring = kUsualTurnSpring;
  limits.slow = kSlowTurn;
  limits.fastest = kFastestTurn;
  return limits;
}

SafetyLimits probe_torque_limits(const HapticDevice& device) {
  HandleParameters handle;
  handle.max_force = device.max_force;
  handle.max_torque = kProbeLever * device.max_force;
  return torque_limits(device, handle);
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
  result.event = fault_of(device, limits, wanted, position, now);
  if (result.event != SafetyEvent::kNone || device.status != DeviceStatus::kReady) {
    let_go(state);
    return result;
  }
  const bool jumped = limits.jumped || jumps(state, device, limits, position, dt);
  dvec3 dx = state.placed && !jumped ? at - state.position - limits.carried / limits.scale : dvec3(0);
  if (jumped) {
    result.event = SafetyEvent::kJumped;
    state.engaged = false;
  }
  if (state.engaged) {
    state.work -= std::max(0.0, limits.stiffened);
    forfeit(state, std::max(0.0, -limits.stiffened));
  }
  Share felt = engage(state, limits, wanted, jumped, dt);
  if (missed > 0.0) ease_in(state, felt.force, felt.weight, dx, missed, limits.ease, dt);
  if (state.eased < 1.0) felt = eased(state, felt, dt);
  const dvec3 passive = damp_excess(state, limits, felt.force, felt.weight, dx, dt);
  const dvec3 change = felt.force - felt.weight - state.wanted;
  state.wanted = felt.force - felt.weight;
  count(state.tally, SafetyLimit::kWithheld, length(felt.force - passive), length(felt.force));
  result.force = slew(state, limits, passive, felt.weight, dx, missed, dt);
  count(state.tally, SafetyLimit::kSlewed, length(passive - result.force),
        std::max(length(passive), length(result.force)));
  book(state, result.force, felt.weight, dx, change);
  state.position = at;
  state.sensed_at = device.sensed_at;
  state.placed = true;
  state.touched = limits.touched;
  state.force = result.force;
  state.weight = felt.weight;
  return result;
}

}  // namespace pliant
