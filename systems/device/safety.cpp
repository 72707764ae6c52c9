#include "systems/device/safety.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

bool finite(dvec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// The norm, never each axis: the direction must stay.
dvec3 clamp_norm(dvec3 v, double most) {
  const double size = length(v);
  return size > most ? v * (most / size) : v;
}

// Only what senses a person can be stale; scripted motion has no age.
bool stale(const HapticDevice& device, double now) {
  return (device.driver == Driver::kExternal || device.driver == Driver::kMouse) &&
         now - device.sensed_at > kStaleAfter;
}

// Scales the force so that the work done on the hand beside the weight, counted over the whole history by the
// trapezoidal rule, cannot become positive, not even if the next step goes on like this one and the contact ends there.
dvec3 keep_passive(SafetyState& state, dvec3 force, dvec3 weight, dvec3 dx) {
  const double spent = state.work + 0.5 * dot(state.force - state.weight, dx);
  const double gain = dot(force, dx), steps = 0.5 + 0.5 * kPassivityReserve;
  if (gain > 0) force *= std::clamp(-(spent - steps * dot(weight, dx)) / (steps * gain), 0.0, 1.0);
  state.work = spent + 0.5 * dot(force - weight, dx);
  return force;
}

}  // namespace

bool plausible_position(dvec3 position) {
  return finite(position) && length(position) < kFarthest;
}

SafetyResult make_safe(SafetyState& state, const HapticDevice& device, dvec3 wanted, dvec3 position, double now,
                       double dt) {
  return make_safe(state, device, {device.max_force, device.max_stiffness, device.max_slew}, wanted, position, now, dt);
}

SafetyResult make_safe(SafetyState& state, const HapticDevice& device, const SafetyLimits& limits, dvec3 wanted,
                       dvec3 position, double now, double dt) {
  SafetyResult result;
  if (!finite(wanted) || !finite(limits.weight) || !plausible_position(position)) {
    result.event = SafetyEvent::kNonFinite;
  } else if (device.status != DeviceStatus::kReady || stale(device, now)) {
    result.event = device.status == DeviceStatus::kReady ? SafetyEvent::kStale : SafetyEvent::kNone;
  } else {
    const dvec3 dx = state.placed ? position - state.position : dvec3(0);
    if (!state.engaged) {
      state.hidden = length(wanted - limits.weight) < length(wanted) ? 1.0 : 0.0;
      state.engaged = length(wanted - state.hidden * limits.weight) < kEngageForce;
    }
    dvec3 force(0), weight(0);
    if (state.engaged) {
      force = clamp_norm(wanted - state.hidden * limits.weight, limits.force);
      weight = clamp_norm((1.0 - state.hidden) * limits.weight, limits.force);
      state.hidden = std::max(0.0, state.hidden - dt / kWeightTime);
    }
    double most = limits.slew * dt;
    if (limits.stiffness > 0) {
      // The force may grow no faster with displacement than the device can render stably; it may always fall. What
      // comes in of a weight is no answer to displacement.
      const double rise = limits.stiffness * length(dx) + length(weight - state.weight);
      if (length(force) > length(state.force)) most = std::min(most, rise);
    }
    force = state.force + clamp_norm(force - state.force, most);
    result.force = keep_passive(state, force, weight, dx);
    state.position = position;
    state.placed = true;
    state.force = result.force;
    state.weight = weight;
    return result;
  }
  // Unknown: nothing leaves, at once, and the gate must be passed again. Work stays booked.
  state.engaged = false;
  state.placed = false;
  state.force = state.weight = dvec3(0);
  return result;
}

}  // namespace pliant
