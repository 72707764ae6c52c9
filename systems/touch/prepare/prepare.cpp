#include "systems/touch/prepare/prepare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "components/name_of.h"
#include "components/probe_shape.h"
#include "components/soft_body.h"
#include "components/varying.h"
#include "runtime/long_work.h"
#include "systems/touch/collide/arc_reach.h"
#include "systems/touch/collide/seams.h"
#include "systems/touch/model/field.h"
#include "systems/touch/model/force_field.h"
#include "systems/touch/model/smooth_paint.h"

namespace pliant {
namespace {

void size_field(HeightField& field, const Mesh& mesh, const Deformable& deformable) {
  const std::size_t size = std::size_t{mesh.zone_count()} * kZoneSize;
  const bool arm = has_arm(deformable.spring);
  if (field.stream.size() != size || field.arm.empty() == arm || !field.set.empty() || deformable.yield_force > 0) {
    field.stream.assign(size, vec4(0));
    field.residual.assign(size, vec4(0));
    field.rate.assign(size, vec4(0));
    field.arm.assign(arm ? size : 0, vec4(0));
    field.relaxed.assign(arm ? size : 0, vec4(0));
    field.set.assign(deformable.yield_force > 0 ? size : 0, vec4(0));
    field.zone_state.assign(mesh.zone_count(), 0);
    field.awake.clear();
  }
  field.awake.reserve(mesh.zone_count());
}

// Every probe gets a device, at least one that never moves it: every force passes the safety layer before it is read.
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

bool is_convex(const Mesh& mesh, std::uint32_t triangle, int edge) {
  const uvec3 t = mesh.triangles[triangle], o = mesh.triangles[mesh.across[triangle][edge]];
  const dvec3 a(mesh.position(t[edge])), b(mesh.position(t[(edge + 1) % 3])), c(mesh.position(t[(edge + 2) % 3]));
  for (int i = 0; i < 3; ++i)
    if (o[i] != t[edge] && o[i] != t[(edge + 1) % 3])
      return dot(dvec3(mesh.position(o[i])) - a, cross(b - a, c - a)) < 0;
  return false;
}

void list_creases(const Mesh& mesh, ObjectState& object) {
  std::vector<Box> boxes;
  for (std::uint32_t t = 0; t < mesh.crease.size(); ++t) {
    for (int edge = 0; edge < 3; ++edge) {
      const std::uint32_t key = 3 * t + static_cast<std::uint32_t>(edge);
      if (!mesh.is_crease(t, edge) || mesh.across[t][edge] == kBorder || !is_convex(mesh, t, edge)) continue;
      if (object.found.bonds.empty() && std::binary_search(object.closed.begin(), object.closed.end(), key))
        continue;  // a crack, which stays
      Box box;
      box.add(mesh.position(mesh.triangles[t][edge]));
      box.add(mesh.position(mesh.triangles[t][(edge + 1) % 3]));
      boxes.push_back(box);
      object.creases.push_back(key);
    }
  }
  object.crease_boxes.build(boxes);
}

constexpr std::size_t kLeastEchoes = 16;  // sources that an object beside seams reserves for dents of its neighbours

std::size_t most_contacts(const ObjectState& object) {
  return kMaxContactsPerObject - (object.seam_zones.empty() ? 0 : kLeastEchoes);
}
// Largest number of simultaneous contacts of a tip with one object: the walls of a corner, and one more.
constexpr std::size_t kContactsOfASphere = 8, kContactsOfAPoint = 2;

// A capsule is one tip, and a row of spheres that are only drawn, up to kMostDrawn, at most kDrawnApart of the smallest
// reach apart.
constexpr double kDrawnApart = 1.0 / 3;
constexpr double kMostDrawn = 32;

std::vector<Tip> tips_of(const Probe& probe, double reach) {
  std::vector<Tip> tips, drawn;
  for (const ProbePart& part : probe_parts(probe)) {
    const dvec3 axis = part.to - part.from;
    tips.push_back({part.from, axis, probe.radius, false});
    const double count =
        part.is_sphere() ? 0.0 : std::clamp(std::ceil(length(axis) / (kDrawnApart * reach)), 1.0, kMostDrawn);
    for (int i = 0; i < static_cast<int>(count) + (count > 0); ++i)
      drawn.push_back({part.from + axis * (double(i) / count), dvec3(0), probe.radius, true});
  }
  tips.insert(tips.end(), drawn.begin(), drawn.end());
  return tips;
}

SourceState make_source(Entity contact, const Mesh& mesh, const Deformable& deformable) {
  SourceState source;
  source.contact = contact;
  source.zones.reserve(mesh.zone_count());
  if (deformable.distance == Distance::kSurface) {
    source.offset.size(mesh);
    source.chart.size(mesh);
  }
  return source;
}

Entity make_contact(Registry& registry, Entity object, std::size_t slot) {
  const Entity entity = registry.create();
  Contact contact;
  contact.object = object;
  contact.object_slot = static_cast<std::uint32_t>(slot);
  registry.add(entity, contact);
  return entity;
}

// Enough for its neighbours' contacts; at least the number reserved by most_contacts().
void make_echoes(const World& world, ObjectState& object) {
  object.first_echo = static_cast<std::uint32_t>(object.sources.size());
  const Deformable& deformable = world.registry.get<Deformable>(object.entity);
  if (object.seam_zones.empty() || deformable.distance == Distance::kSurface) return;
  const std::size_t wanted = 2 * object.sources.size();
  while (object.sources.size() < std::min<std::size_t>(wanted, kMaxContactsPerObject))
    object.sources.push_back(make_source(kNoEntity, world.meshes[deformable.mesh], deformable));
}

// Distance::kSurface: up to the reach of a dent as deep as half the largest tip's radius.
void prepare_distance(World& world, const TouchState& touch, ObjectState& object) {
  const Deformable& deformable = world.registry.get<Deformable>(object.entity);
  if (deformable.distance != Distance::kSurface) return;
  const Mesh& mesh = world.meshes[deformable.mesh];
  double radius = 0.0;
  for (const ProbeState& probe : touch.probes)
    for (const Tip& tip : probe.tips) radius = std::max(radius, tip.radius);
  object.march.size(mesh);
  object.ways.sides = sides_of(mesh);
  const double reach = std::max(deformable.reach, kLeastReach * mesh.mean_edge);
  object.ways.hubs = chart_hubs(mesh, reach);
  object.ways.arc_reach = arc_reach(mesh, object.ways.sides, object, reach + radius);
}

bool something_presses(Registry& registry) {
  for (auto [entity, body] : registry.view<const RigidBody>())
    if (!body.fixed) return true;
  const auto soft = registry.view<const SoftBody>();
  return soft.begin() != soft.end();
}

// Contacts that tissue may drive, as many as the probes leave room for.
void make_presses(World& world, TouchState& touch) {
  for (ObjectState& object : touch.objects) {
    const Deformable& deformable = world.registry.get<Deformable>(object.entity);
    while (object.presses.size() < kMaxPresses && object.sources.size() < most_contacts(object)) {
      const Entity contact = make_contact(world.registry, object.entity, std::size_t(&object - touch.objects.data()));
      object.sources.push_back(make_source(contact, world.meshes[deformable.mesh], deformable));
      object.presses.push_back({contact, false, {}});
    }
  }
  touch.presses =
      std::make_unique<TripleBuffer<Presses>>(Presses{0.0, std::vector<ObjectPresses>(touch.objects.size())});
}

void drop_contacts(Registry& registry) {
  std::vector<Entity> old;
  for (auto [entity, contact] : registry.view<Contact>()) old.push_back(entity);
  for (const Entity entity : old) registry.destroy(entity);
}

struct TipCount {
  std::uint32_t all = 0;
  std::size_t contacts = 0;  // of all tips with one object, at the same time
};

// `reach` [m] the smallest of all objects.
TipCount list_probes(Registry& registry, TouchState& touch, double reach) {
  TipCount count;
  for (auto [entity, probe] : registry.view<Probe>()) {
    const bool meets_surfaces = probe.meets != ProbeMeets::kBodies;
    ProbeState& state = touch.probes.emplace_back();
    state.entity = entity;
    state.first_tip = count.all;
    if (meets_surfaces) state.tips = tips_of(probe, reach);
    for (const Tip& tip : state.tips) {
      state.lever = std::max({state.lever, length(tip.place), length(tip.place + tip.axis)});
      count.contacts += tip.radius > 0 && !tip.drawn ? kContactsOfASphere : kContactsOfAPoint;
    }
    count.all += static_cast<std::uint32_t>(state.tips.size());
  }
  count.contacts = std::min<std::size_t>(count.contacts, kMaxContactsPerObject);
  return count;
}

// The object without its sources, and its field in the right size.
ObjectState make_object(World& world, Entity entity, const Pose& pose, double dt, std::uint32_t tips) {
  const Deformable& deformable = world.registry.get<Deformable>(entity);
  const Mesh& mesh = world.meshes[deformable.mesh];
  HeightField& field = world.fields[deformable.field];
  ObjectState object;
  object.entity = entity;
  const FieldOn on = field_on(world, entity);
  object.on_gpu = on == FieldOn::kGpuSources;
  if (object.on_gpu) {
    field = {};
    object.releases.reserve(kMaxReleases);
    object.terms.reserve(2 * kMaxReleases + kMaxContactsPerObject);
  } else {
    size_field(field, mesh, deformable);
  }
  object.motion = motion(deformable, dt);
  object.painted = paint_motion(object.motion, mesh);
  object.texture = texture_of(deformable);
  const double reach = std::max(deformable.reach, kLeastReach * static_cast<double>(mesh.mean_edge));
  const double contact = contact_radius(deformable, reach);
  object.kernel = share_kernel(deformable.shape, reach, deformable.volume, contact / reach);
  object.felt_stiffness = felt_paint(mesh, mesh.stiffness_factor, contact);
  object.felt_relaxation = felt_paint(mesh, mesh.relaxation_factor, contact);
  object.searched.assign(tips, {dvec3(std::numeric_limits<double>::max()), dvec3(0)});
  object.clear.resize(tips);
  object.world_box = touch_box(mesh, pose);
  object.blocks = blocks_of(mesh);
  object.zone_sources.assign(mesh.zone_count(), 0);
  object.visited.assign(mesh.zone_count(), 0);
  object.dirty.reserve(mesh.zone_count());
  if (!deformable.layers.empty()) object.holes.reserve(kMostHoles);
  if (deformable.yield_force > 0) {
    object.sets.reserve(kMostSets);
    object.set_zones.reserve(mesh.zone_count());
  }
  if (on == FieldOn::kGpuSteps)
    object.feed_writer =
        FeedWriter(mesh.zone_count(), kMaxContactsPerObject, deformable.distance == Distance::kSurface);
  for (std::uint32_t zone = 0; zone < field.zone_state.size(); ++zone) {  // zones not at rest must be published again
    field.zone_state[zone] &= kZoneListed | kZoneResidual;
    if (field.zone_state[zone]) {
      field.zone_state[zone] |= kZoneDirty;
      object.dirty.push_back(zone);
    }
  }
  object.feed_writer.begin_if_at_rest(object, field);
  return object;
}

// Room for what the object publishes.
ObjectSnapshot snapshot_of(ObjectState& object, const Mesh& mesh) {
  const std::size_t published = object.on_gpu ? 0 : std::min(mesh.zone_count(), kMaxPublishedZones);
  object.waiting.reserve(published);
  return {object.entity,
          0,
          std::vector<std::uint32_t>(published),
          std::vector<vec4>(published * kZoneSize),
          0,
          object.on_gpu,
          0,
          std::vector<FieldSource>(object.terms.capacity()),
          object.feed_writer.feed(),
          false};
}

// A pool that grows moves its sources: a copy would have no room for the zones.
static_assert(std::is_nothrow_move_constructible_v<SourceState>);

// A source for every contact that the probes can have with an object.
void make_sources(World& world, TouchState& touch, std::size_t contacts) {
  for (ObjectState& object : touch.objects) {
    const Deformable& deformable = world.registry.get<Deformable>(object.entity);
    const std::size_t slot = std::size_t(&object - touch.objects.data());
    while (object.sources.size() < std::min(contacts, most_contacts(object)))
      object.sources.push_back(
          make_source(make_contact(world.registry, object.entity, slot), world.meshes[deformable.mesh], deformable));
    object.probe_sources = static_cast<std::uint32_t>(object.sources.size());
    object.tips.reserve(object.probe_sources);
    if (!world.fields[deformable.field].awake.empty()) {  // an earlier recovery continues
      object.listed = true;
      touch.awake.push_back(static_cast<std::uint32_t>(slot));
    }
  }
}

// Stiffness over seams that are closed at the start, so that a jump from one surface to the other is a ridge as wide as
// a contact, like one that is painted.
void feel_over_seams(const World& world, TouchState& touch) {
  const Registry& registry = world.registry;
  for (ObjectState& object : touch.objects) {
    const Deformable& here = registry.get<Deformable>(object.entity);
    const Pose& pose = registry.get<Pose>(object.entity);
    std::vector<FlushPaint> flush;
    for (const std::uint32_t slot : object.neighbours) {
      const ObjectState& other = touch.objects[slot];
      if (&other == &object) continue;
      const Deformable& there = registry.get<Deformable>(other.entity);
      flush.push_back({&world.meshes[there.mesh], relative_pose(pose, registry.get<Pose>(other.entity)),
                       there.stiffness / here.stiffness, &world.meshes[there.mesh].stiffness_factor});
    }
    if (flush.empty()) continue;
    const Mesh& mesh = world.meshes[here.mesh];
    const double reach = std::max(here.reach, kLeastReach * static_cast<double>(mesh.mean_edge));
    object.flush_stiffness = felt_paint(mesh, mesh.stiffness_factor, contact_radius(here, reach), flush);
  }
}

}  // namespace

Box touch_box(const Mesh& mesh, const Pose& pose) {
  const vec3 low = mesh.box.min - mesh.tree.bulge, high = mesh.box.max + mesh.tree.bulge;
  Box box;
  for (int i = 0; i < 8; ++i) {
    const vec3 corner(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    box.add(vec3(pose.to_world(dvec3(corner))));
  }
  return box;
}

void renew_box(const World& world, TouchState& touch, std::uint32_t slot) {
  ObjectState& object = touch.objects[slot];
  const Mesh& mesh = world.meshes[world.registry.get<Deformable>(object.entity).mesh];
  object.world_box = touch_box(mesh, world.registry.get<Pose>(object.entity));
  touch.object_boxes.move(slot, object.world_box);
}

Status prepare_touch(World& world) {
  Registry& registry = world.registry;
  give_devices(registry);
  drop_contacts(registry);
  auto touch = std::make_shared<TouchState>();
  touch->dt = 1.0 / world.simulation.touch_rate;
  double reach = std::numeric_limits<double>::max();
  for (auto [entity, deformable, pose] : registry.view<Deformable, const Pose>()) {
    if (deformable.reach == 0.0) deformable.reach = default_reach(world.meshes[deformable.mesh]);
    if (Status status = check(deformable, name_of(world, entity, fmt::format("entity {}", entity.index))); !status)
      return status.error();
    reach = std::min(reach, deformable.reach);
  }
  const TipCount tips = list_probes(registry, *touch, reach);

  Box extent;
  Snapshot snapshot;
  for (auto [entity, deformable, pose] : registry.view<Deformable, const Pose>()) {
    const Mesh& mesh = world.meshes[deformable.mesh];
    check_in("preparing what is touched, now `" + name_of(world, entity, fmt::format("entity {}", entity.index)) + "`");
    ObjectState object = make_object(world, entity, pose, touch->dt, tips.all);
    object.accounts.resize(touch->probes.size());
    snapshot.objects.push_back(snapshot_of(object, mesh));
    extent.add(object.world_box);
    touch->objects.push_back(std::move(object));
  }
  touch->extent = extent.empty() ? 1.0 : extent.diagonal();

  touch->awake.reserve(touch->objects.size());
  touch->loaded.resize(kMaxContactsPerObject);
  touch->events.reserve(kMostEventsInATick);
  std::vector<Box> boxes;
  for (const ObjectState& object : touch->objects) boxes.push_back(object.world_box);
  touch->object_boxes.build(boxes);
  touch->moving = find_moving(world, *touch);
  find_seams(world, *touch);
  feel_over_seams(world, *touch);
  for (ObjectState& object : touch->objects)
    list_creases(world.meshes[registry.get<Deformable>(object.entity).mesh], object);
  for (ObjectState& object : touch->objects) prepare_distance(world, *touch, object);
  make_sources(world, *touch, tips.contacts);
  std::size_t most = 0;
  for (const ObjectState& object : touch->objects) most += object.probe_sources;
  touch->tracked.reserve(most);
  if (something_presses(registry)) make_presses(world, *touch);
  for (ObjectState& object : touch->objects) make_echoes(world, object);
  snapshot.probes.resize(touch->probes.size());
  snapshot.moved = moved_snapshots(world, *touch);
  world.snapshots = std::make_unique<TripleBuffer<Snapshot>>(snapshot);
  world.touch = std::move(touch);
  return Done{};
}

std::size_t touch_bytes(const Mesh& mesh, const HeightField& field) {
  const auto bytes = [](const auto&... vectors) { return ((vectors.capacity() * sizeof(vectors[0])) + ...); };
  std::size_t total = bytes(mesh.px, mesh.py, mesh.pz, mesh.nx, mesh.ny, mesh.nz, mesh.area, mesh.triangles,
                            mesh.across, mesh.zone_box, mesh.tree.nodes, mesh.zone_neighbour_first,
                            mesh.zone_neighbours, mesh.stiffness_factor, mesh.friction_factor, field.stream,
                            field.residual, field.rate, field.arm, field.relaxed, field.zone_state, field.awake) +
                      mesh.zone_count() * sizeof(ZoneBlocks);
  for (const auto& level : mesh.tree.levels) total += bytes(level);
  return total;
}

}  // namespace pliant
