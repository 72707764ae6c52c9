#include "systems/touch/prepare.h"

#include <fmt/format.h>

#include "components/soft_body.h"
#include "systems/touch/field.h"

namespace pliant {
namespace {

std::string name_of(const World& world, Entity entity) {
  const Name* name = world.registry.find<Name>(entity);
  return name ? name->value : fmt::format("entity {}", entity.index);
}

void size_field(HeightField& field, const Mesh& mesh, const Deformable& deformable) {
  const std::size_t size = std::size_t{mesh.zone_count()} * kZoneSize;
  const bool arm = deformable.spring == SpringLaw::kStandardLinearSolid;
  if (field.stream.size() != size || field.arm.empty() == arm) {
    field.stream.assign(size, vec4(0));
    field.residual.assign(size, vec4(0));
    field.rate.assign(size, vec4(0));
    field.arm.assign(arm ? size : 0, vec4(0));
    field.zone_state.assign(mesh.zone_count(), 0);
    field.awake.clear();
  }
  field.awake.reserve(mesh.zone_count());
}

Box world_box(const Mesh& mesh, const Pose& pose) {
  Box box;
  for (int i = 0; i < 8; ++i) {
    const vec3 corner(i & 1 ? mesh.box.max.x : mesh.box.min.x, i & 2 ? mesh.box.max.y : mesh.box.min.y,
                      i & 4 ? mesh.box.max.z : mesh.box.min.z);
    box.add(vec3(pose.to_world(dvec3(corner))));
  }
  return box;
}

// Every probe needs a device, if only one that never moves it: safety stands between every force and whoever reads it.
void give_devices(Registry& registry) {
  std::vector<Entity> without;
  for (auto [entity, probe] : registry.view<Probe>())
    if (!registry.alive(probe.device) || !registry.has<HapticDevice>(probe.device)) without.push_back(entity);
  for (const Entity entity : without) {
    if (!registry.has<HapticDevice>(entity)) {
      HapticDevice device;
      device.position = registry.get<Probe>(entity).position;
      registry.add(entity, device);
    }
    registry.get<Probe>(entity).device = entity;
  }
}

SourceState make_source(Entity contact, const Mesh& mesh, const Deformable& deformable) {
  SourceState source;
  source.contact = contact;
  source.zones.reserve(mesh.zone_count());
  if (deformable.distance == Distance::kSurface) {
    source.offset.assign(mesh.px.size(), vec3(kFar));
    source.heap.reserve(std::size_t{8} * mesh.vertex_count);
  }
  return source;
}

Entity make_contact(Registry& registry, Entity probe, Entity object, std::size_t slot) {
  const Entity entity = registry.create();
  Contact contact;
  contact.probe = probe;
  contact.object = object;
  contact.object_slot = static_cast<std::uint32_t>(slot);
  registry.add(entity, contact);
  return entity;
}

bool something_presses(Registry& registry) {
  for (auto [entity, body] : registry.view<const RigidBody>())
    if (!body.fixed) return true;
  const auto soft = registry.view<const SoftBody>();
  return soft.begin() != soft.end();
}

// Contacts that flesh may drive, as many as probes have left room for.
void make_presses(World& world, TouchState& touch) {
  for (ObjectState& object : touch.objects) {
    const Deformable& deformable = world.registry.get<Deformable>(object.entity);
    while (object.presses.size() < kMaxPresses && object.sources.size() < kMaxContactsPerObject) {
      const Entity contact =
          make_contact(world.registry, kNoEntity, object.entity, std::size_t(&object - touch.objects.data()));
      object.sources.push_back(make_source(contact, world.meshes[deformable.mesh], deformable));
      object.presses.push_back({contact, false, {}});
    }
  }
  touch.presses =
      std::make_unique<TripleBuffer<Presses>>(Presses{0.0, std::vector<ObjectPresses>(touch.objects.size())});
}

}  // namespace

Status prepare_touch(World& world) {
  Registry& registry = world.registry;
  give_devices(registry);
  std::vector<Entity> old;
  for (auto [entity, contact] : registry.view<Contact>()) old.push_back(entity);
  for (const Entity entity : old) registry.destroy(entity);

  auto touch = std::make_shared<TouchState>();
  touch->dt = 1.0 / world.simulation.touch_rate;
  for (auto [entity, probe] : registry.view<Probe>()) touch->probes.push_back({entity, {}, {}});

  Box extent;
  Snapshot snapshot;
  for (auto [entity, deformable, pose] : registry.view<Deformable, const Pose>()) {
    const Mesh& mesh = world.meshes[deformable.mesh];
    if (deformable.reach == 0.0) deformable.reach = 0.08 * mesh.box.diagonal();
    if (Status status = check(deformable, name_of(world, entity)); !status) return status.error();
    HeightField& field = world.fields[deformable.field];
    ObjectState object;
    object.entity = entity;
    object.on_card = world.field_place == FieldPlace::kCard && card_obstacle(deformable).empty();
    if (object.on_card) {
      field = {};
      object.releases.reserve(kMaxReleases);
      object.terms.reserve(2 * kMaxReleases + kMaxContactsPerObject);
    } else {
      size_field(field, mesh, deformable);
    }
    object.motion = motion(deformable, touch->dt);
    object.world_box = world_box(mesh, pose);
    object.zone_sources.assign(mesh.zone_count(), 0);
    object.visited.assign(mesh.zone_count(), 0);
    object.dirty.reserve(mesh.zone_count());
    for (std::uint32_t zone = 0; zone < field.zone_state.size(); ++zone) {  // what is not at rest must be shown again
      field.zone_state[zone] &= kZoneListed | kZoneResidual;
      if (field.zone_state[zone]) {
        field.zone_state[zone] |= kZoneDirty;
        object.dirty.push_back(zone);
      }
    }
    const std::size_t published = object.on_card ? 0 : std::min(mesh.zone_count(), kMaxPublishedZones);
    object.waiting.reserve(published);
    snapshot.objects.push_back({entity, 0, std::vector<std::uint32_t>(published),
                                std::vector<vec4>(published * kZoneSize), 0, object.on_card, 0,
                                std::vector<FieldSource>(object.terms.capacity())});
    extent.add(object.world_box);
    touch->objects.push_back(std::move(object));
  }
  touch->extent = extent.empty() ? 1.0 : extent.diagonal();

  // One contact per (probe, object) pair.
  for (ObjectState& object : touch->objects) {
    const Deformable& deformable = registry.get<Deformable>(object.entity);
    for (ProbeState& probe : touch->probes) {
      if (object.sources.size() == kMaxContactsPerObject) {
        world.dropped |= kDroppedContacts;
        break;
      }
      const Entity entity =
          make_contact(registry, probe.entity, object.entity, std::size_t(&object - touch->objects.data()));
      object.sources.push_back(make_source(entity, world.meshes[deformable.mesh], deformable));
      probe.contacts.push_back(entity);
    }
  }
  if (something_presses(registry)) make_presses(world, *touch);
  snapshot.probes.resize(touch->probes.size());
  world.snapshots = std::make_unique<TripleBuffer<Snapshot>>(snapshot);
  world.touch = std::move(touch);
  return Done{};
}

std::size_t touch_bytes(const Mesh& mesh, const HeightField& field) {
  const auto bytes = [](const auto&... vectors) { return ((vectors.capacity() * sizeof(vectors[0])) + ...); };
  std::size_t total =
      bytes(mesh.px, mesh.py, mesh.pz, mesh.nx, mesh.ny, mesh.nz, mesh.area, mesh.triangles, mesh.across, mesh.zone_box,
            mesh.zone_neighbour_first, mesh.zone_neighbours, mesh.stiffness_factor, mesh.friction_factor, field.stream,
            field.residual, field.rate, field.arm, field.zone_state, field.awake);
  for (const auto& level : mesh.tree.levels) total += bytes(level);
  return total;
}

}  // namespace pliant
