#include "systems/device/devices.h"

#include "systems/device/mouse.h"
#include "systems/device/path.h"
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
}

}  // namespace pliant
