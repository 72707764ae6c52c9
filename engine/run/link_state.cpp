#include "engine/run/link_state.h"

#include <algorithm>

namespace pliant {

void LinkState::to(DeviceState state, DeviceCause cause, double now) {
  report_.kept[report_.transitions % DeviceReport::kKept] = {report_.state, state, cause, now, report_.force};
  ++report_.transitions;
  report_.state = state;
  report_.cause = cause;
}

// A stop applies even without the device, and overrides an order to arm.
void LinkState::follow_orders(double now) {
  const std::uint32_t given = orders_.exchange(0, std::memory_order_relaxed);
  renewed_ = false;
  // A device that renders nothing cannot be stopped.
  if (!(can_.renders_force || can_.renders_torque || can_.renders_grip || can_.renders_vibration)) return;
  if (given & kStop) {
    if (report_.state != DeviceState::kTripped) to(DeviceState::kTripped, DeviceCause::kEmergencyStop, now);
    latched_ = true;
  } else if (given & kDisarm) {
    if (report_.state == DeviceState::kActive) to(DeviceState::kIdle, DeviceCause::kDisarmed, now);
    latched_ = true;
  } else if ((given & kArm) && latched_) {
    latched_ = false;
    renewed_ = true;
    to(came_ ? DeviceState::kActive : DeviceState::kDisconnected, DeviceCause::kArmedByHand, now);
  }
}

// A warning in the newest sample takes its share at once or within kFadeTime; a low battery latches.
void LinkState::warn(double elapsed) {
  const double since = std::clamp(elapsed, 0.0, 0.01);
  const std::uint32_t warnings = report_.sample.warnings;
  if (warnings & kDeviceBatteryLow) {
    share_ = std::max(0.0, share_ - since / kFadeTime);
    if (share_ > 0.0 || report_.state != DeviceState::kActive) return;
    to(DeviceState::kTripped, DeviceCause::kBatteryLow, now_);
    latched_ = true;
    return;
  }
  const double most = warnings & kDeviceWarm ? 0.5 : 1.0;
  share_ = std::min(most, share_ + since / kRise);
}

bool LinkState::sense(const DeviceSample* sample, double now) {
  const double before = now_;
  now_ = now;
  ++report_.figures.periods;
  follow_orders(now);
  if (sample) {
    ++report_.figures.samples;
    if (!sample->ready) ++report_.dropped.not_ready;
    report_.sample = *sample;
    came_at_ = now;
    came_ = sample->ready;
    if (came_ && report_.state == DeviceState::kDisconnected && !latched_)
      to(DeviceState::kActive, DeviceCause::kConnected, now);
    if (!came_ && report_.state == DeviceState::kActive) to(DeviceState::kDisconnected, DeviceCause::kNotReady, now);
  } else {
    ++report_.figures.without_sample;
    if (now - came_at_ > kLostAfter) came_ = false;
    if (!came_ && report_.state == DeviceState::kActive) to(DeviceState::kDisconnected, DeviceCause::kNoSample, now);
  }
  warn(now - before);
  return renewed_;
}

double LinkState::may_leave(const DeviceWrench& wrench, double now) {
  const bool may = !latched_;
  const double share = may ? share_ : 0.0;
  report_.wanted = wrench;
  report_.sent = {share * wrench.force, share * wrench.torque, share * wrench.grip};
  report_.force = length(report_.sent.force);
  if (now - reported_at_ >= kReportEvery || !reported_ || renewed_ || !may) publish_report(now);
  return share;
}

void LinkState::rest(const DeviceSample* sample) {
  follow_orders(now_);
  if (sample) report_.sample = *sample;
  report_.wanted = report_.sent = {};
  report_.force = 0.0;
  publish_report(now_);
}

void LinkState::publish_report(double now) {
  if (now - reported_at_ >= kReportEvery) {
    report_.figures.rate = static_cast<double>(report_.figures.samples - reported_samples_) / (now - reported_at_);
    reported_at_ = now;
    reported_samples_ = report_.figures.samples;
  }
  report_.max_force = can_.max_force;
  report_.sample_age = report_.figures.samples > 0 ? now - came_at_ : -1.0;
  reported_ = true;
  reports_.write() = report_;
  reports_.publish();
}

const DeviceReport& LinkState::report() {
  reports_.acquire();
  return reports_.read();
}

}  // namespace pliant
