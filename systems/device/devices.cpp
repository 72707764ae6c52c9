#include "systems/device/devices.h"

#include <algorithm>
#include <limits>

#include "components/soft_body.h"
#include "systems/device/mouse.h"
#include "systems/device/path.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/touch_state.h"

namespace pliant {
namespace {

// Drivers whose motion is known beforehand are sampled here; it is in world coordinates, so `scale` is not theirs. The
// others have written position and sensed_at themselves.
void sense(const World& world, HapticDevice& device, double time) {
  if (!device.path.valid()) return;
  const PathRow row = sample_path(world.paths[device.path], time);
  device.position = row.position;
  device.rotation = row.rotation;
  device.sensed_at = time;
}

// A tool's wrench, by the same layer: its torque as if it were a force, work counted over the angles turned. What is
// unknown of the one is unknown of the other, so that both are let go and engaged together.
void write_tool(World& world, ToolTouchState& tool, Tick tick) {
  HapticDevice& device = world.registry.get<HapticDevice>(tool.device);
  const Handle6& handle = world.registry.get<Handle6>(tool.entity);
  const bool posed = tool.sensing || device.status != DeviceStatus::kReady;  // Ready without a pose: no pose at all
  const bool known = posed && tool.device_wrench.allFinite();
  const dvec3 unknown(std::numeric_limits<double>::quiet_NaN());
  const SafetyLimits limits{device.max_force, device.max_stiffness, device.max_slew, tool.weight};
  const SafetyResult force = make_safe(tool.force_safety, device, limits, known ? linear(tool.device_wrench) : unknown,
                                       device.position, tick.time, tick.dt);
  const SafetyLimits torque_limits{handle.max_torque, 0.0,
                                   device.max_slew * handle.max_torque / std::max(handle.max_force, 1e-9),
                                   cross(tool.sensed.pose.rotation * tool.balance, tool.weight)};
  const SafetyResult torque = make_safe(tool.torque_safety, device, torque_limits,
                                        known ? angular(tool.device_wrench) : unknown, tool.turned, tick.time, tick.dt);
  for (const SafetyResult& result : {force, torque}) {
    if (result.event == SafetyEvent::kNonFinite) world.dropped |= kDroppedNonFinite;
    if (result.event == SafetyEvent::kStale) world.dropped |= kDroppedStale;
  }
  device.force_sent = force.force;
  device.torque_sent = torque.force;
}

}  // namespace

void read_devices(World& world, Tick tick) {
  read_mouse(world, tick);
  for (auto [entity, device] : world.registry.view<HapticDevice>()) sense(world, device, tick.time);
  for (auto [entity, probe] : world.registry.view<Probe>()) {
    const HapticDevice& device = world.registry.get<HapticDevice>(probe.device);
    if (!plausible_position(device.position)) {
      world.dropped |= kDroppedNonFinite;  // the probe stays where it was; safety sends nothing
      probe.velocity = dvec3(0);
      continue;
    }
    probe.fresh = !probe.placed;
    probe.previous = probe.placed ? probe.position : device.position;
    probe.position = device.position;
    probe.rotation = device.rotation;
    probe.velocity = (probe.position - probe.previous) / tick.dt;
    probe.placed = true;
    if (length(probe.position - probe.previous) > world.touch->extent) world.dropped |= kDroppedTravel;
  }
}

void write_devices(World& world, Tick tick) {
  for (ProbeState& state : world.touch->probes) {
    const Probe& probe = world.registry.get<Probe>(state.entity);
    HapticDevice& device = world.registry.get<HapticDevice>(probe.device);
    const SafetyResult safe = make_safe(state.safety, device, probe.force, device.position, tick.time, tick.dt);
    if (safe.event == SafetyEvent::kNonFinite) world.dropped |= kDroppedNonFinite;
    if (safe.event == SafetyEvent::kStale) world.dropped |= kDroppedStale;
    device.force_sent = safe.force;
  }
  if (!world.tools) return;
  for (const std::unique_ptr<ToolTouchState>& tool : world.tools->tools) write_tool(world, *tool, tick);
}

}  // namespace pliant
