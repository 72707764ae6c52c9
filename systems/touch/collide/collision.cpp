// Finds and tracks the contacts of each probe on each surface. A contact is found by sweeping the tick's segment, so
// that nothing tunnels. From then on its foot is tracked downhill from the last foot, which keeps the probe on its side
// of however thin a part. A sphere has a contact at every local minimum of the distance within its radius: both walls
// of a groove. All in the object's frame, from the tip's place on the object a tick ago to its place now: the result
// depends only on the relative motion.
#include "systems/touch/collide/collision.h"

#include "systems/touch/collide/follow_contact.h"
#include "systems/touch/collide/new_contacts.h"

namespace pliant {

void drop_contact(SourceState& source, Contact& contact) {
  source.tracked = false;
  contact.state = ContactState::kFree;
  contact.probe = kNoEntity;
  contact.load = contact.share = contact.normal_force = 0.0;
  contact.force = dvec3(0);
}

TipPlace tip_place(const Probe& probe, const Tip& tip) {
  return {probe.position + probe.rotation * tip.place, probe.rotation * tip.axis};
}

TipPlace tip_place_before(const Probe& probe, const Tip& tip) {
  return {probe.previous + probe.previous_rotation * tip.place, probe.previous_rotation * tip.axis};
}

namespace {

TipPlace to_local(const Pose& pose, const TipPlace& place) {
  return {pose.to_local(place.end), glm::conjugate(pose.rotation) * place.axis};
}

// By probe; of one probe in the order of objects and their sources. Mostly they come in that order.
void list_tracked(TouchState& touch) {
  std::vector<TrackedContact>& tracked = touch.tracked;
  tracked.clear();
  for (const std::uint32_t slot : touch.awake) {
    const ObjectState& object = touch.objects[slot];
    for (const TrackedTip& tip : object.tips) {
      const SourceState& source = object.sources[tip.source];
      if (!source.tracked) continue;
      auto after = tracked.end();
      while (after != tracked.begin() && std::prev(after)->probe.index > tip.probe.index) --after;
      tracked.insert(after, {tip.probe, source.contact});  // capacity: all
    }
  }
}

}  // namespace

void collision(World& world, Tick tick) {
  TouchState& touch = *world.touch;
  Registry& registry = world.registry;
  for (const std::uint32_t slot : touch.awake) {
    ObjectState& object = touch.objects[slot];
    const Deformable& deformable = registry.get<Deformable>(object.entity);
    const ContactSearch search{world, object, world.meshes[deformable.mesh], world.fields[deformable.field], tick};
    const Pose& pose = registry.get<Pose>(object.entity);
    std::uint32_t followed = 0;
    std::erase_if(object.tips, [&](const TrackedTip& tip) { return !object.sources[tip.source].tracked; });
    for (const TrackedTip& tip : object.tips) {
      SourceState& source = object.sources[tip.source];
      if (source.born == tick.index + 1) continue;  // carried over a seam in this tick
      Contact& contact = registry.get<Contact>(source.contact);
      const Probe& probe = registry.get<Probe>(contact.probe);
      follow_contact(search, source, contact, to_local(pose, tip_place(probe, source.tip)));
      ++followed;
    }
    if (followed > 1) merge_contacts(search);
  }
  for (const ProbeState& state : touch.probes) {
    const Probe& probe = registry.get<Probe>(state.entity);
    if (!probe.placed) continue;
    for (std::size_t t = 0; t < state.tips.size(); ++t) {
      const Tip& tip = state.tips[t];
      const TipPlace to = tip_place(probe, tip), from = probe.fresh ? to : tip_place_before(probe, tip);
      const double band = tip.radius * (1 + kAhead) + 2 * kEarly * touch.extent + touch.crack;
      Box swept;
      for (const dvec3& end : {from.end, from.at(1), to.end, to.at(1)}) {
        swept.add(vec3(end - dvec3(band)));
        swept.add(vec3(end + dvec3(band)));
      }
      touch.object_boxes.visit(swept, [&](std::uint32_t slot) {
        ObjectState& object = touch.objects[slot];
        if (object.world_box.empty()) return;  // the object is removed
        const Deformable& deformable = registry.get<Deformable>(object.entity);
        const ContactSearch search{world, object, world.meshes[deformable.mesh], world.fields[deformable.field], tick};
        find_new_contacts(search, {state.entity, static_cast<std::uint8_t>(t), tip},
                          object.searched[state.first_tip + t], object.clear[state.first_tip + t], probe.fresh,
                          to_local(pose_before(registry, object.entity), from),
                          to_local(registry.get<Pose>(object.entity), to));
      });
    }
  }
  list_tracked(touch);
}

}  // namespace pliant
