#include "systems/device/mouse.h"

#include <algorithm>

#include "systems/safety/safety.h"

namespace pliant {

namespace {

// Starts at the device's last position on its path, so that it does not jump.
void take_over(World& world, Entity taken, MouseInput& mouse) {
  HapticDevice* device = taken == kNoEntity ? nullptr : world.registry.find<HapticDevice>(taken);
  if (!device || device->driver == DriverKind::kMouse) return;
  for (auto [entity, other] : world.registry.view<HapticDevice>())
    if (other.driver == DriverKind::kMouse) {  // nothing moves it from now on
      other.driver = DriverKind::kExternal;
      other.status = DeviceStatus::kLost;
    }
  device->driver = DriverKind::kMouse;
  device->path = {};
  device->status = DeviceStatus::kReady;
  mouse.position = mouse.to = device->position;
}

}  // namespace

void read_mouse(World& world, Tick tick) {
  if (!world.mouse) return;
  MouseInput& mouse = *world.mouse;
  bool first = false, free = false;
  if (mouse.samples.acquire()) {
    first = !mouse.heard;
    mouse.lasts = mouse.heard ? std::clamp(tick.time - mouse.heard_at, tick.dt, kMouseSlowestFrame) : tick.dt;
    mouse.heard = true;
    mouse.heard_at = tick.time;
    mouse.began_at = tick.skipped < kEasedFrom ? tick.time : tick.time - tick.skipped;
    take_over(world, mouse.samples.read().takes, mouse);
    const bool free_now = mouse.samples.read().free, arrived = mouse.position == mouse.to;
    mouse.to = mouse.samples.read().position;
    for (auto [entity, probe] : world.registry.view<Probe>())
      if (world.registry.get<HapticDevice>(probe.device).driver == DriverKind::kMouse)
        probe.hold = mouse.samples.read().hold;
    free = free_now && mouse.free && arrived;  // the way out of a press is traversed, not jumped: force acts along it
    mouse.free = free_now;
    mouse.from = free ? mouse.to : mouse.position;
    mouse.lasts = std::max(mouse.lasts, length(mouse.to - mouse.from) / kMouseFastest);
  }
  if (!mouse.heard || tick.time - mouse.heard_at > kMouseSilence) return;
  const double share = std::min(1.0, (tick.time - mouse.began_at + tick.dt) / mouse.lasts);
  mouse.position = share < 1.0 ? mouse.from + share * (mouse.to - mouse.from) : mouse.to;
  for (auto [entity, device] : world.registry.view<HapticDevice>()) {
    if (device.driver != DriverKind::kMouse) continue;
    if (first) device.status = DeviceStatus::kReady;
    device.position = mouse.position;
    device.sensed_at = tick.time;
  }
  if (!free) return;
  for (auto [entity, probe] : world.registry.view<Probe>())  // no swept segment from the earlier position
    if (world.registry.get<HapticDevice>(probe.device).driver == DriverKind::kMouse) probe.placed = false;
}

void add_mouse(World& world, dvec3 start) {
  world.mouse = std::make_shared<MouseInput>(start);
  for (auto [entity, device] : world.registry.view<HapticDevice>()) {
    if (device.driver != DriverKind::kMouse) continue;
    device.status = DeviceStatus::kLost;
    device.position = start;
  }
}

}  // namespace pliant
