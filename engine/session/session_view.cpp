#include "engine/session/session_view.h"

#include <algorithm>
#include <utility>

#include "components/soft_body.h"
#include "systems/touch/feed/publish.h"

namespace pliant {

void SessionView::reset(const World& world) {
  shown_.clear();
  soft_.clear();
  contacts_.clear();
  handles_.clear();
  seen = {};
  soft_seen = {};
  ++version_;
  tick_ = 0, complete_ = true;
  for (auto [entity, pose] : world.registry.view<const Pose>()) {
    Shown shown{entity, pose.matrix(), {}, {}};
    if (const Deformable* surface = world.registry.find<Deformable>(entity)) {
      shown.changed.assign(world.meshes[surface->mesh].zone_count(), 1);
      shown.stream.assign(shown.changed.size() * kZoneSize, vec4(0));
    }
    shown_.push_back(std::move(shown));
  }
}

void SessionView::add(const Snapshot& snapshot) {
  const auto of = [&](Entity entity) {
    return std::find_if(shown_.begin(), shown_.end(), [&](const Shown& s) { return s.object == entity; });
  };
  for (const ObjectSnapshot& object : snapshot.objects) {
    const auto shown = of(object.object);
    if (shown == shown_.end()) continue;
    for (std::uint32_t i = 0; i < object.zone_count; ++i) {
      std::copy_n(object.stream.begin() + static_cast<std::ptrdiff_t>(i) * kZoneSize, kZoneSize,
                  shown->stream.begin() + static_cast<std::ptrdiff_t>(object.zones[i]) * kZoneSize);
      shown->changed[object.zones[i]] = 1;
    }
  }
  for (const MovedSnapshot& moved : snapshot.moved) {
    const auto shown = of(moved.object);
    if (shown != shown_.end()) shown->to_world = moved.to_world;
  }
}

void SessionView::take(World& world) {
  while (world.snapshots->acquire()) {
    ++version_;
    add(world.snapshots->read());
    tick_ = world.snapshots->read().tick, complete_ = world.snapshots->read().complete;
    if (seen) seen(world.snapshots->read());
  }
  if (!world.soft_snapshots || !world.soft_snapshots->acquire()) return;
  ++version_;
  soft_ = world.soft_snapshots->read().objects;
  contacts_ = world.soft_snapshots->read().contacts;
  handles_ = world.soft_snapshots->read().handles;
  if (soft_seen) soft_seen(world.soft_snapshots->read());
}

void SessionView::take_all(World& world, Tick tick) {
  // Each iteration takes as many zones as fit and the next takes the rest, so the loop ends.
  do {
    publish(world, tick);
    take(world);
  } while (waits_to_be_published(world));
}

const std::vector<vec4>* SessionView::stream(Entity object) const {
  for (const Shown& shown : shown_)
    if (shown.object == object && !shown.stream.empty()) return &shown.stream;
  return nullptr;
}

bool SessionView::take_changes(Entity object, std::vector<vec4>& out, std::vector<StreamPart>& changed) {
  changed.clear();
  const auto shown = std::find_if(shown_.begin(), shown_.end(),
                                  [&](const Shown& s) { return s.object == object && !s.stream.empty(); });
  if (shown == shown_.end()) return false;
  if (out.size() != shown->stream.size()) {
    out.resize(shown->stream.size());
    std::fill(shown->changed.begin(), shown->changed.end(), std::uint8_t{1});
  }
  for (std::uint32_t zone = 0; zone < shown->changed.size(); ++zone) {
    if (!std::exchange(shown->changed[zone], std::uint8_t{0})) continue;
    const std::uint32_t first = zone * kZoneSize;
    std::copy_n(shown->stream.begin() + first, kZoneSize, out.begin() + first);
    if (!changed.empty() && changed.back().first + changed.back().count == first)
      changed.back().count += kZoneSize;
    else
      changed.push_back({first, kZoneSize});
  }
  return true;
}

const SoftObjectSnapshot* SessionView::soft(Entity object) const {
  for (const SoftObjectSnapshot& shown : soft_)
    if (shown.object == object) return &shown;
  return nullptr;
}

mat4 SessionView::rest_to_world(const World& world, Entity object) const {
  if (!world.registry.has<SoftBody>(object) || world.registry.has<Handle6>(object)) return to_world(world, object);
  for (const Shown& shown : shown_)
    if (shown.object == object) return shown.to_world;
  return world.registry.get<WorldTransform>(object).matrix;
}

mat4 SessionView::to_world(const World& world, Entity object) const {
  if (const SoftObjectSnapshot* moving = soft(object)) return moving->pose.matrix();
  for (const Shown& shown : shown_)
    if (shown.object == object) return shown.to_world;
  return world.registry.get<WorldTransform>(object).matrix;
}

}  // namespace pliant
