#include "engine/run/journal.h"

#include <algorithm>
#include <cmath>

#include "content/files/limits.h"
#include "systems/device/hands.h"
#include "systems/hash_state.h"
#include "systems/tool/tool_touch_state.h"
#include "systems/touch/feed/contacts_of.h"

namespace pliant {

std::size_t rows_that_wait(double seconds, double rate, std::size_t hands) {
  const std::size_t each = std::max<std::size_t>(hands, 1);
  const auto ticks = static_cast<std::size_t>(std::ceil(seconds * rate));
  return std::min(ticks, std::max<std::size_t>(most(limits::kJournal) / (sizeof(TickRow) * each), 2)) * each;
}

Journal::Journal(const World& world, double seconds, const BodyJournal* bodies)
    : bodies_(bodies),
      probes_(hands(world)),
      recorder_(rows_that_wait(seconds, world.simulation.touch_rate, probes_.size())) {
  for (const Entity probe : probes_) safety_.push_back(find_safety(world, probe));
  for (auto [entity, deformable] : world.registry.view<Deformable>()) awake_.push_back({entity, 0, 0});
  for (const Entity hand : probes_) {
    hands_.emplace_back();
    hands_.back().now.resize(awake_.size());
    hands_.back().ever.resize(awake_.size());
    for (std::size_t i = 0; world.tools && i < world.tools->tools.size(); ++i)
      if (world.tools->tools[i]->entity == hand) hands_.back().tool = world.tools->tools[i].get();
  }
}

// Tool fields known to the touch clock: the state used by the tick just run.
void Journal::note_tool(Hand& hand, Tick tick, TickRow& row) {
  const ToolTouchState& tool = *hand.tool;
  const HandleModel& model = tool.model.read();
  if (bodies_) {
    row.objects += bodies_->touching(tool.entity);
    if (row.reading.in_contact && row.reading.object == kNoEntity)
      row.reading.object = bodies_->touches_most(tool.entity);
  }
  row.late = tool.ticks_late > hand.late;
  row.stale = tool.placed() && tick.time - model.time > kStaleSteps * model.soft_step;
  hand.late = tool.ticks_late;
}

void Journal::note_probe(const World& world, Entity probe, Hand& hand, TickRow& row) {
  std::fill(hand.now.begin(), hand.now.end(), std::uint8_t{0});
  for_contacts_of(world, probe, [&](const Contact& contact) {
    if (contact.state != ContactState::kTouching) return;
    for (std::size_t i = 0; i < awake_.size(); ++i)
      if (awake_[i].object == contact.object) hand.now[i] = hand.ever[i] = 1;
  });
  row.objects = static_cast<std::uint32_t>(std::count(hand.now.begin(), hand.now.end(), 1));
}

std::vector<Entity> Journal::touched(Entity entity) const {
  std::vector<Entity> objects;
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    if (!(probes_[i] == entity)) continue;
    if (hands_[i].tool && bodies_) objects = bodies_->touched(entity);
    for (std::size_t k = 0; k < awake_.size(); ++k)
      if (hands_[i].ever[k]) objects.push_back(awake_[k].object);
  }
  return objects;
}

void Journal::note(const World& world, Tick tick) {
  for (std::uint32_t i = 0; i < probes_.size(); ++i) {
    TickRow row;
    row.tick = tick.index;
    row.time = tick.time;
    row.probe = i;
    row.reading = reading(world, probes_[i]);
    if (const HapticDevice* device = find_device(world, probes_[i])) {
      row.device_position = device->position;
      row.device_rotation = device->rotation;
      row.torque = device->torque_sent;
    }
    row.limited = safety_[i].now();
    if (world.registry.has<Probe>(probes_[i])) note_probe(world, probes_[i], hands_[i], row);
    if (hands_[i].tool) note_tool(hands_[i], tick, row);
    recorder_.record(row);
  }
  for (AwakeStats& stats : awake_) {
    const std::uint32_t awake = world.fields[world.registry.get<Deformable>(stats.object).field].awake_vertices;
    stats.sum += awake;
    stats.max = std::max(stats.max, awake);
  }
  for (const TouchEvent& event : world.touch->events) events_.record(event);
  hash_forces(world, hash_);
  ++ticks_;
}

}  // namespace pliant
