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

}  // namespace pliant
