// Output of a tick for the owner of a Session. On the touch clock: nothing here allocates.
#include <algorithm>

#include "engine/session/session_run.h"
#include "systems/device/devices.h"
#include "systems/device/reading.h"
#include "systems/device/softening.h"
#include "systems/safety/safety.h"
#include "systems/touch/feed/contacts_of.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

std::uint32_t index_of(const std::vector<Entity>& objects, Entity object) {
  const auto found = std::find(objects.begin(), objects.end(), object);
  return found == objects.end() ? Reading::kNone : static_cast<std::uint32_t>(found - objects.begin());
}

void add_contact(const World& world, const std::vector<Entity>& objects, const Contact& contact, EffectorRow& row) {
  if (contact.state != ContactState::kTouching || row.reading.contacts == Reading::kMostContacts) return;
  const Pose& pose = world.registry.get<Pose>(contact.object);
  const Mesh& mesh = world.meshes[world.registry.get<Deformable>(contact.object).mesh];
  const std::size_t i = row.reading.contacts++;
  row.reading.contact[i] = {
      pose.to_world(contact.foot),      pose.rotation * contact.normal, contact.force, -contact.height, contact.sliding,
      index_of(objects, contact.object)};
  row.vertices[i] = mesh.triangles[contact.triangle];
  row.weights[i] = vec3(contact.barycentric);
}

}  // namespace

void SessionRun::after(Tick tick) {
  last = tick;
  shown = false;
  std::vector<EffectorRow>& out = rows.write();
  for (std::size_t i = 0; i < effectors.size(); ++i) {
    SessionEffector& effector = effectors[i];
    if (effector.link) effector.link.write(world, effector.entity, effector.device, tick);
    HapticDevice& device = world.registry.get<HapticDevice>(effector.device);
    const SafetyState* const safety = safety_of(world, effector.entity);
    const bool felt = !safety || safety->felt;
    if ((replayed || restoring) && !felt) device.force_sent = device.torque_sent = dvec3(0);
    const DeviceWrench wrench{device.force_sent, device.torque_sent};
    EffectorRow& row = out[i];
    const ProbeReading read = pliant::reading(world, effector.entity);
    row.reading.tick = tick.index;
    row.reading.time = tick.time;
    row.reading.ready = device.status == DeviceStatus::kReady && tick.time - device.sensed_at <= kStaleAfter;
    if (recorder)
      recorder->note(tick.index, static_cast<std::uint32_t>(i), device, row.reading.ready && !after_pause, felt);
    row.reading.touching = read.in_contact;
    row.reading.position = read.position;
    row.reading.force = wrench.force;
    row.reading.torque = wrench.torque;
    row.reading.depth = read.depth;
    row.reading.normal = read.normal;
    row.reading.object = index_of(object_entities, read.object);
    row.reading.contacts = 0;
    if (world.registry.has<Probe>(effector.entity))
      for_contacts_of(world, effector.entity,
                      [&](const Contact& contact) { add_contact(world, object_entities, contact, row); });
    if (keeps > 0) kept[i]->record(row);
  }
  if (!restoring) {
    for (const TouchEvent& event : world.touch->events) events->record(event);
    events->lose(world.touch->events_over);
  }
  after_pause = false;
  rows.publish();
  shown = true;
  if (noted) noted(tick);
}

}  // namespace pliant
