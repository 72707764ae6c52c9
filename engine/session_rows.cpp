// What a tick tells the owner of a Session, and the edits that come in before one. On the touch clock: nothing here
// allocates.
#include <algorithm>

#include "engine/session_parts.h"
#include "systems/device/devices.h"
#include "systems/device/reading.h"
#include "systems/device/softening.h"
#include "systems/safety/safety.h"
#include "systems/touch/contacts_of.h"
#include "systems/touch/local_model.h"
#include "systems/touch/presence.h"

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

void Session::Parts::after(Tick tick) {
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
  after_pause = false;
  rows.publish();
  shown = true;
  if (noted) noted(tick);
}

const std::vector<LiveKey>& live_keys() {
  using D = DeformableParameters;
  using H = DeviceParameters;
  static const std::vector<LiveKey> keys{
      {"stiffness", &D::stiffness, nullptr},
      {"damping_ratio", &D::damping_ratio, nullptr},
      {"settling_time", &D::settling_time, nullptr},
      {"contact_damping", &D::contact_damping, nullptr},
      {"friction_static", &D::friction_static, nullptr},
      {"friction_sliding", &D::friction_sliding, nullptr},
      {"max_force", nullptr, &H::max_force},
      {"max_stiffness", nullptr, &H::max_stiffness},
      {"max_slew", nullptr, &H::max_slew},
  };
  return keys;
}

Status check_edit(const std::string& name, const Deformable& surface, const Mesh& mesh, const LiveKey& key,
                  double value) {
  const bool painted =
      !mesh.stiffness_factor.empty() || !mesh.damping_factor.empty() || !mesh.relaxation_factor.empty();
  const bool moves = key.surface == &DeformableParameters::stiffness ||
                     key.surface == &DeformableParameters::damping_ratio ||
                     key.surface == &DeformableParameters::settling_time;
  if (painted && moves)
    return Error{"`" + name + "`: " + key.key,
                 "is painted on this surface, and is read when the session opens; change the scene instead"};
  if (surface.young > 0.0 && key.surface == &DeformableParameters::stiffness)
    return Error{"`" + name + "`: stiffness", "follows from its Young's modulus; change `young` in the scene instead"};
  Deformable changed = surface;
  changed.*(key.surface) = value;
  return check(changed, name);
}

void apply_edit(World& world, const Edit& edit) {
  if (edit.kind == EventKind::kHandForce) return set_hand_force(world, edit.entity, edit.force, edit.torque);
  if (edit.kind == EventKind::kPlace && world.registry.has<Deformable>(edit.entity))
    return place_surface(world, edit.entity, {edit.force, edit.rotation});
  if (edit.kind == EventKind::kPresent && edit.value != 0.0) return put_back_surface(world, edit.entity);
  if (edit.kind == EventKind::kPresent) return take_out_surface(world, edit.entity);
  if (edit.kind != EventKind::kSet) return;  // the soft clock's, and only stamped here
  const LiveKey& key = live_keys()[edit.key];
  if (key.device) {
    world.registry.get<HapticDevice>(edit.entity).*(key.device) = edit.value;
    return;
  }
  Deformable& surface = world.registry.get<Deformable>(edit.entity);
  surface.*(key.surface) = edit.value;
  for (ObjectState& object : world.touch->objects)
    if (object.entity == edit.entity) object.motion = edit.motion;
}

}  // namespace pliant
