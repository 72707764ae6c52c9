#include "engine/run/pose_replay.h"

#include "systems/device/hands.h"
#include "systems/device/softening.h"
#include "systems/safety/safety.h"

namespace pliant {

PoseReplay::PoseReplay(World& world, const Recording& recording)
    : world_(&world), recording_(&recording), hands_(hands(world)) {
  for (const Entity hand : hands_) {
    devices_.push_back(find_device(world, hand) ? device_of(world, hand) : kNoEntity);
    if (devices_.back() == kNoEntity) continue;
    HapticDevice& device = world.registry.get<HapticDevice>(devices_.back());
    device.driver = DriverKind::kExternal;
    device.path = {};
  }
}

Tick PoseReplay::begin_tick(std::size_t n) {
  const double dt = 1.0 / world_->simulation.touch_rate;
  const std::uint64_t index = recording_->ticks[n], next = n > 0 ? recording_->ticks[n - 1] + 1 : index;
  const Tick tick{index, dt, static_cast<double>(index) * dt,
                  index > next ? static_cast<double>(index - next) * dt : 0.0};
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    if (devices_[i] == kNoEntity) continue;
    const RecordedPose& pose = recording_->poses[n * hands_.size() + i];
    HapticDevice& device = world_->registry.get<HapticDevice>(devices_[i]);
    device.position = pose.position;
    device.rotation = pose.rotation;
    device.grip = pose.grip, device.grips = pose.grips;
    device.status = pose.ready ? DeviceStatus::kReady : DeviceStatus::kLost;
    device.sensed_at = tick.time;
    if (SafetyState* const safety = safety_of(*world_, hands_[i])) safety->felt = pose.felt;
  }
  return tick;
}

void PoseReplay::end_tick() {
  for (std::size_t i = 0; i < hands_.size(); ++i) {
    const SafetyState* const safety = safety_of(*world_, hands_[i]);
    if (devices_[i] == kNoEntity || !safety || safety->felt) continue;
    HapticDevice& device = world_->registry.get<HapticDevice>(devices_[i]);
    device.force_sent = device.torque_sent = dvec3(0);
  }
}

}  // namespace pliant
