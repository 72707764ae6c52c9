// Applies parameter changes between two ticks. Runs on the touch clock; nothing here allocates.
#include "engine/session/live_edit.h"
#include "systems/device/devices.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/prepare/presence.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

void take(World& world, Entity entity, const SurfaceSetting& setting) {
  static_cast<DeformableParameters&>(world.registry.get<Deformable>(entity)) = setting.now;
  for (ObjectState& object : world.touch->objects) {
    if (object.entity != entity) continue;
    object.motion = setting.motion;
    object.kernel = setting.kernel;
    object.texture = texture_of(setting.now);
  }
}

void take(World& world, Entity entity, const DeviceParameters& now) {
  static_cast<DeviceParameters&>(world.registry.get<HapticDevice>(entity)) = now;
}

// The contact continues as if the probe had always had this radius: growth is not motion and causes no damping force.
void take(World& world, Entity entity, const ProbeSetting& setting) {
  Probe& probe = world.registry.get<Probe>(entity);
  const double grown = setting.radius - probe.radius;
  probe.radius = setting.radius;
  for (ProbeState& state : world.touch->probes)
    if (state.entity == entity)
      for (Tip& tip : state.tips) tip.radius = setting.radius;
  for (ObjectState& object : world.touch->objects)
    for (std::uint32_t i = 0; i < object.probe_sources; ++i) {
      SourceState& source = object.sources[i];
      Contact& contact = world.registry.get<Contact>(source.contact);
      if (!source.tracked || contact.probe != entity) continue;
      source.tip.radius = setting.radius;
      contact.height -= grown;
      contact.previous_height -= grown;
      contact.older_height -= grown;
    }
}

void take(World& world, Entity entity, const CouplingSetting& now) {
  const auto set = [&](HandleParameters& handle) {
    handle.translation = now.translation;
    handle.rotation = now.rotation;
    handle.max_force = now.max_force;
    handle.max_torque = now.max_torque;
  };
  if (Handle6* const handle = world.registry.find<Handle6>(entity)) set(*handle);
  if (!world.tools) return;
  for (const auto& tool : world.tools->tools)
    if (tool->is_probe && tool->entity == entity) set(tool->settings);
}

void take(World& world, Entity entity, const WeightSetting& setting) {
  for (const auto& tool : world.tools->tools)
    if (tool->entity == entity) tool->weight = setting.weight;
}

void take(World& world, Entity entity, const EffectSetting& now) {
  now.to(world.registry.get<Effect>(entity));
}

void take(World& world, Entity entity, const EventEdit& event) {
  const bool surface = world.registry.has<Deformable>(entity);
  if (event.kind == EventKind::kHandForce) set_hand_force(world, entity, event.force, event.torque);
  if (event.kind == EventKind::kPlace && surface) place_surface(world, entity, {event.force, event.rotation});
  if (event.kind != EventKind::kPresent) return;
  if (event.value != 0.0)
    put_back_surface(world, entity);
  else
    take_out_surface(world, entity);
}

}  // namespace

void apply_edit(World& world, const Edit& edit) {
  std::visit([&](const auto& now) { take(world, edit.entity, now); }, edit.now);
}

}  // namespace pliant
