#include "player/journal.h"

#include <algorithm>
#include <cmath>

#include "systems/device/hands.h"
#include "systems/touch/hash_state.h"

namespace pliant {

Journal::Journal(const World& world, double seconds)
    : probes_(hands(world)),
      recorder_(static_cast<std::size_t>(std::ceil(seconds * world.simulation.touch_rate)) *
                std::max<std::size_t>(probes_.size(), 1)) {
  for (const Entity probe : probes_) safety_.push_back(find_safety(world, probe));
  for (auto [entity, deformable] : world.registry.view<Deformable>()) awake_.push_back({entity, 0, 0});
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
      row.device_ready = device->status == DeviceStatus::kReady;
    }
    row.limited = safety_[i].now();
    recorder_.record(row);
  }
  for (AwakeStats& stats : awake_) {
    const std::uint32_t awake = world.fields[world.registry.get<Deformable>(stats.object).field].awake_vertices;
    stats.sum += awake;
    stats.max = std::max(stats.max, awake);
  }
  hash_forces(world, hash_);
  ++ticks_;
}

}  // namespace pliant
