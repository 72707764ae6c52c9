#include "engine/session/live_world.h"

#include <cmath>

#include "components/name_of.h"
#include "components/soft_body.h"
#include "systems/device/hands.h"
#include "systems/soft/soft_state.h"

namespace pliant {
namespace {

constexpr std::size_t kMostLiveEdits = 256;  // capacity

template <class T>
void keep_component(const World& world, Entity entity, std::optional<T>& out) {
  if (const T* const it = world.registry.find<T>(entity)) out = *it;
}

}  // namespace

LiveWorld::LiveWorld(World& world) : world_(world), edits_(kMostLiveEdits) {
  const auto of = [&](Entity entity) -> LiveNamed& {
    LiveNamed& named = named_[name_of(world, entity)];
    named.name = name_of(world, entity);
    keep_component(world, entity, named.node.handle);
    keep_component(world, entity, named.node.probe);
    keep_component(world, entity, named.node.deformable);
    if (named.node.deformable) return named;
    keep_component(world, entity, named.node.soft_body);
    keep_component(world, entity, named.node.rigid_body);
    return named;
  };
  for (auto [entity, pose] : world.registry.view<const Pose>()) {
    const Registry& all = world.registry;
    if (all.has<Deformable>(entity) || all.has<SoftBody>(entity) || all.has<RigidBody>(entity))
      of(entity).object = entity;
  }
  for (const Entity hand : hands(world)) {
    LiveNamed& named = of(hand);
    named.hand = hand;
    named.device = device_of(world, hand);
    if (named.device != kNoEntity) keep_component(world, named.device, named.node.device);
  }
  for (auto [entity, effect] : world.registry.view<const Effect>()) {
    LiveNamed& named = of(entity);
    named.several_effects = named.effect != kNoEntity;
    named.effect = entity;
    named.node.effect = effect;
  }
}

TickPart LiveWorld::tick_part(PoseRecorder* recorder) {
  recorder_ = recorder;
  TickPart part;
  part.before = [this](Tick tick) {
    Edit edit;
    while (edits_.pop(edit)) {
      apply_edit(world_, edit);
      if (recorder_ && edit.number > 0) recorder_->stamp(edit.number, tick.index);
    }
  };
  return part;
}

Result<double> LiveWorld::get(const std::string& object, const std::string& key) const {
  const auto named = named_.find(object);
  if (named == named_.end()) return Error{"`" + object + "`", "is not in the level", {}, "name.unknown"};
  const Result<FoundKey> found = find_named_key(named->second, key, false);
  if (!found) return found.error();
  return found->key->get(&named->second.node).get<double>();
}

Status LiveWorld::set(const std::string& object, const std::string& key, double value) {
  const auto named = named_.find(object);
  if (named == named_.end()) return Error{"`" + object + "`", "is not in the level", {}, "name.unknown"};
  Result<LiveSet> set = live_set(world_, named->second, key, value);
  if (!set) return set.error();
  SessionChange& change = set->change;
  const bool soft = world_.soft && !change.soft.empty();
  if (!edits_.has_room() || (soft && !world_.soft->parameter_edits.has_room()))
    return Error{"`" + object + "`: " + key, "waits for a tick", "let the run go on"};
  if (change.touch.empty()) change.touch.push_back({change.entity, EventEdit{}, 0});
  if (recorder_) {
    RecordedEvent event;
    event.kind = EventKind::kSet;
    event.name = object;
    event.key = set->words();
    change.touch.front().number = recorder_->announce(event);
  }
  for (const Edit& edit : change.touch) edits_.push(edit);
  if (soft)
    for (const ParameterEdit& edit : change.soft) world_.soft->parameter_edits.push(edit);
  named->second.node = set->now;
  return Done{};
}

}  // namespace pliant
