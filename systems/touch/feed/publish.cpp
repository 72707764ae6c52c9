// Dirty zones, probe poses and forces -> TripleBuffer, for the visual clock.
#include "systems/touch/feed/publish.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/feed/contacts_of.h"

namespace pliant {
namespace {

void mark_dirty(ObjectState& object, HeightField& field, std::uint32_t zone) {
  if (field.zone_state[zone] & kZoneDirty) return;
  field.zone_state[zone] |= kZoneDirty;
  object.dirty.push_back(zone);
}

// Copies dirty zones, newest first, up to the snapshot's capacity. True when none is left.
bool copy_zones(ObjectState& object, HeightField& field, ObjectSnapshot& out) {
  out.object = object.entity;
  out.awake_vertices = field.awake_vertices;
  out.zone_count = 0;
  out.on_gpu = object.on_gpu;
  object.feed_writer.begin_if_at_rest(object, field);
  out.fed = object.feed_writer.feeds();
  out.term_count = static_cast<std::uint32_t>(object.terms.size());
  std::copy(object.terms.begin(), object.terms.end(), out.terms.begin());
  while (!object.dirty.empty() && out.zone_count < out.zones.size()) {
    const std::uint32_t zone = object.dirty.back();
    object.dirty.pop_back();
    field.zone_state[zone] &= static_cast<std::uint8_t>(~kZoneDirty);
    std::copy_n(field.stream.begin() + zone * kZoneSize, kZoneSize, out.stream.begin() + out.zone_count * kZoneSize);
    out.zones[out.zone_count++] = zone;
  }
  return object.dirty.empty();
}

}  // namespace

void publish(World& world, Tick tick) {
  TouchState& touch = *world.touch;
  Snapshot& snapshot = world.snapshots->write();
  snapshot.tick = tick.index;
  snapshot.time = tick.time;
  snapshot.complete = true;
  for (std::size_t i = 0; i < touch.objects.size(); ++i) {
    ObjectState& object = touch.objects[i];
    HeightField& field = world.fields[world.registry.get<Deformable>(object.entity).field];
    snapshot.complete &= copy_zones(object, field, snapshot.objects[i]);
  }
  for (std::size_t i = 0; i < touch.probes.size(); ++i) {
    const Probe& probe = world.registry.get<Probe>(touch.probes[i].entity);
    ProbeSnapshot& out = snapshot.probes[i];
    out = {touch.probes[i].entity,
           probe.position,
           probe.rotation,
           world.registry.get<HapticDevice>(probe.device).force_sent,
           false,
           0.0,
           dvec3(0),
           0,
           {}};
    for_contacts_of(world, touch.probes[i].entity, [&](const Contact& contact) {
      if (contact.state != ContactState::kTouching) return;
      const Pose& pose = world.registry.get<Pose>(contact.object);
      if (!out.touching || -contact.height > out.depth) out.normal = pose.rotation * contact.normal;
      if (out.contact_count < kMostShownContacts)
        out.contacts[out.contact_count++] = {pose.to_world(contact.foot), contact.force};
      out.touching = true;
      out.depth = std::max(out.depth, -contact.height);
    });
  }
  publish_moved(world, snapshot);
  const bool last_was_seen = world.snapshots->publish();
  touch.unseen = last_was_seen ? 0 : touch.unseen + 1;
  for (std::size_t i = 0; i < touch.objects.size(); ++i) {
    ObjectState& object = touch.objects[i];
    HeightField& field = world.fields[world.registry.get<Deformable>(object.entity).field];
    // Zones that were replaced unseen are sent again.
    if (!last_was_seen)
      for (const std::uint32_t zone : object.waiting) mark_dirty(object, field, zone);
    const ObjectSnapshot& sent = snapshot.objects[i];
    object.waiting.assign(sent.zones.begin(), sent.zones.begin() + sent.zone_count);  // capacity: kMaxPublishedZones
  }
}

bool waits_to_be_published(const World& world) {
  return std::any_of(world.touch->objects.begin(), world.touch->objects.end(),
                     [](const ObjectState& object) { return !object.dirty.empty(); });
}

void publish_paced(World& world, Tick tick) {
  const std::uint64_t every =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::lround(1 / (tick.dt * kPublishRate))));
  if (tick.index % every != 0) return;
  // Without a reader the dirty zones only grow: every zone touched so far would be copied again and again.
  if (world.touch->unseen > kPatience && world.snapshots->unseen()) return;
  publish(world, tick);
}

}  // namespace pliant
