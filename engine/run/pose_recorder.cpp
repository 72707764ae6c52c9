#include "engine/run/pose_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "content/files/limits.h"
#include "systems/device/devices.h"
#include "systems/device/hands.h"
#include "systems/device/softening.h"
#include "systems/safety/safety.h"

namespace pliant {
namespace {

constexpr std::size_t kMostStamps = 4096;  // capacity [events]
constexpr std::size_t kRoom = 8192;        // capacity [ticks]
constexpr auto kDrainEvery = std::chrono::milliseconds(20);

std::size_t room_for(std::size_t effectors) {
  return std::clamp<std::size_t>(most(limits::kJournal) / (sizeof(PoseRow) * effectors), 2, kRoom);
}

}  // namespace

PoseRecorder::PoseRecorder(std::unique_ptr<RecordingSink> sink, std::size_t effectors)
    : sink_(std::move(sink)),
      room_(room_for(effectors)),
      last_(effectors),
      rows_(room_ * effectors),
      stamps_(kMostStamps) {}

void PoseRecorder::note(std::uint64_t tick, std::uint32_t effector, const HapticDevice& device, bool ready, bool felt) {
  RecordedPose& last = last_[effector];
  const bool sound = plausible_position(device.position) && plausible_rotation(device.rotation);
  if (sound) last = {device.position, device.rotation, ready};
  last.ready = sound && ready;
  last.felt = felt;
  last.grips = device.grips, last.grip = std::clamp(device.grip, 0.0, 1.0);
  rows_.record({tick, effector, last});
}

void PoseRecorder::note(World& world, const std::vector<Entity>& hands, Tick tick) {
  for (std::uint32_t i = 0; i < hands.size(); ++i) {
    static const HapticDevice none;
    const HapticDevice* const device = find_device(world, hands[i]);
    const SafetyState* const safety = safety_of(world, hands[i]);
    const bool ready = device && device->status == DeviceStatus::kReady && tick.time - device->sensed_at <= kStaleAfter;
    note(tick.index, i, device ? *device : none, ready, !safety || safety->felt);
  }
}

std::uint32_t PoseRecorder::announce(const RecordedEvent& event) {
  const std::lock_guard lock(events_mutex_);
  announced_.push_back(event);
  return next_announced_++;
}

// Stamps are drained after the rows, so those of the rows' ticks and of earlier ones are present.
void PoseRecorder::write_events(std::uint64_t until) {
  const std::lock_guard lock(events_mutex_);
  std::size_t done = 0;
  for (; done < stamped_.size() && stamped_[done].tick <= until; ++done) {
    while (first_announced_ < stamped_[done].number) announced_.pop_front(), ++first_announced_;
    RecordedEvent event = announced_.front();
    announced_.pop_front(), ++first_announced_;
    event.tick = stamped_[done].tick;
    sink_->event(event);
  }
  stamped_.erase(stamped_.begin(), stamped_.begin() + static_cast<std::ptrdiff_t>(done));
}

// A full ring, or an aborted tick, leaves an incomplete tick, which is dropped.
void PoseRecorder::drain() {
  taken_.clear();
  rows_.drain(taken_);
  stamps_.drain(stamped_);
  for (const PoseRow& row : taken_) {
    if (row.effector == 0) {
      pending_.clear();
      pending_tick_ = row.tick;
    }
    if (row.tick != pending_tick_ || row.effector != pending_.size()) continue;
    pending_.push_back(row.pose);
    if (pending_.size() < last_.size()) continue;
    write_events(row.tick);
    sink_->tick(row.tick);
    for (const RecordedPose& pose : pending_) sink_->pose(pose);
  }
}

void PoseRecorder::start() {
  thread_ = std::jthread([this](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      drain();
      std::this_thread::sleep_for(kDrainEvery);
    }
  });
}

Status PoseRecorder::finish() {
  if (thread_.joinable()) thread_.request_stop(), thread_.join();
  drain();
  if (Status written = sink_->finish(); !written) return written;
  if (rows_.lost() > 0)
    return Error{"recording", fmt::format("{} poses were lost because writing fell behind", rows_.lost()),
                 "use a faster disk"};
  return Done{};
}

}  // namespace pliant
