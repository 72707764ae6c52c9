#include "systems/device/hands.h"

#include "components/soft_body.h"

namespace pliant {

std::vector<Entity> hands(const World& world) {
  std::vector<Entity> all;
  for (auto [entity, probe] : world.registry.view<Probe>()) all.push_back(entity);
  for ([[maybe_unused]] auto [entity, handle] : world.registry.view<Handle6>()) all.push_back(entity);
  return all;
}

Entity device_of(const World& world, Entity hand) {
  if (const Probe* probe = world.registry.find<Probe>(hand)) return probe->device;
  const Handle6* handle = world.registry.find<Handle6>(hand);
  if (!handle) return kNoEntity;
  return handle->device.empty() ? hand : find_by_name(world, handle->device);
}

const HapticDevice* find_device(const World& world, Entity hand) {
  const Entity device = device_of(world, hand);
  return device == kNoEntity ? nullptr : world.registry.find<HapticDevice>(device);
}

Entity add_free_probe(World& world, const std::string& name, double radius, dvec3 position) {
  const Entity entity = world.registry.create();
  Probe probe;
  probe.radius = radius;
  probe.device = entity;
  world.registry.add(entity, Name{name});
  world.registry.add(entity, probe);
  HapticDevice device;
  device.driver = DriverKind::kExternal;
  device.position = position;
  device.max_force = 1e9;
  device.max_slew = 1e12;
  world.registry.add(entity, device);
  return entity;
}

}  // namespace pliant
