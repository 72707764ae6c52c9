#include "systems/device/reading.h"

#include "systems/tool/tool_reading.h"
#include "systems/touch/feed/contacts_of.h"
#include "systems/touch/model/field.h"

namespace pliant {
namespace {

// Height of the surface at the contact's virtual vertex, after the tick. [m]
double surface_height(const World& world, const Contact& contact) {
  const Deformable& deformable = world.registry.get<Deformable>(contact.object);
  const Mesh& mesh = world.meshes[deformable.mesh];
  const ObjectState& object = world.touch->objects[contact.object_slot];
  double height = 0.0;
  for (int i = 0; i < 3; ++i)
    height += contact.barycentric[i] *
              surface_at(object, mesh, world.fields[deformable.field], mesh.triangles[contact.triangle][i]).height;
  return height;
}

}  // namespace

ProbeReading reading(const World& world, Entity entity) {
  if (!world.registry.has<Probe>(entity)) return tool_reading(world, entity);
  const Probe& probe = world.registry.get<Probe>(entity);
  ProbeReading out;
  out.position = probe.position;
  out.force = world.registry.get<HapticDevice>(probe.device).force_sent;
  const Contact* main = nullptr;
  for_contacts_of(world, entity, [&](const Contact& contact) {
    const bool touching = contact.state == ContactState::kTouching,
               had = main && main->state == ContactState::kTouching;
    if (!main || touching > had || (touching == had && contact.normal_force > main->normal_force)) main = &contact;
  });
  if (main) {
    out.in_contact = main->state == ContactState::kTouching;
    out.object = main->object;
    out.depth = -main->height;
    out.height = surface_height(world, *main);
    out.normal = world.registry.get<Pose>(main->object).rotation * main->normal;
  }
  out.normal_force = std::abs(dot(out.force, out.normal));
  out.tangential_force = length(out.force - dot(out.force, out.normal) * out.normal);
  add_body_reading(world, entity, out);
  return out;
}

}  // namespace pliant
