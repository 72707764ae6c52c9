// An arm's firmware and mechanism: it answers every report with its encoders, drives its motors, and switches them off
// 0.5 s after the last report. The encoders count whole counts from where it was switched on.
#pragma once

#include <cmath>
#include <numbers>

#include "devices/drivers/polhem_kinematics.h"
#include "tests/drivers/emulated_hid.h"

namespace pliant {

class EmulatedPolhem {
 public:
  explicit EmulatedPolhem(const PolhemConfig& config) : config_(config) {
    hid.on_packet = [this](std::span<const std::uint8_t> packet) { hear(packet); };
    angles = parked();
    for (std::size_t i = 0; i < 3; ++i) offset_[i] = -raw(i);
  }
  // The pose in which the encoders are set: upper arm upright, forearm level.
  dvec3 parked() const {
    return polhem_angles(config_, {std::int16_t(config_.home[0]), std::int16_t(config_.home[1]),
                                   std::int16_t(config_.home[2]), 0, 0, 0});
  }
  // Moves it; it reports only after the next report from the host.
  void move(const dvec3& to) { angles = to; }
  void press_button() { requested_ = true; }
  // Its own clock: the watchdog.
  void pass(double seconds) {
    silent_ += seconds;
    if (silent_ > 0.5) currents = dvec3(0), enabled = false;
  }
  std::array<std::int16_t, 6> counts() const {
    std::array<std::int16_t, 6> out{};
    for (std::size_t i = 0; i < 6; ++i) out[i] = static_cast<std::int16_t>((i < 3 ? raw(i) : turn[i - 3]) + offset_[i]);
    return out;
  }
  void answer() {
    std::array<std::uint8_t, 64> report{};
    const std::array<std::int16_t, 6> now = counts();
    for (std::size_t i = 0; i < 6; ++i) put_le16(report, 2 * i, now[i] + (i == 3 && pen_button ? 10000 : 0));
    put_le16(report, 12, requested_ ? 1 : 0);
    hid.say(report);
  }

  dvec3 angles{0};            // [rad] of its bodies
  dvec3 currents{0};          // [A] in its motors
  std::array<int, 3> turn{};  // counts of the gimbal
  bool enabled = false, pen_button = false;
  int refused = 0;
  EmulatedHid hid;

 private:
  int raw(std::size_t i) const {
    const int axis = static_cast<int>(i);
    return static_cast<int>(std::lround(angles[axis] * config_.sign[axis] * config_.body[axis] / config_.capstan[axis] *
                                        config_.counts[axis] / (2.0 * std::numbers::pi)));
  }
  void hear(std::span<const std::uint8_t> packet) {
    if (packet.size() != 65 || packet[0] != 0) {
      ++refused;
      return;
    }
    const auto s16 = [&](std::size_t at) { return static_cast<std::int16_t>(packet[at] | packet[at + 1] << 8); };
    silent_ = 0.0;
    enabled = true;
    currents = dvec3(0);
    if (s16(7) == 1) {
      for (std::size_t i = 0; i < 3; ++i) {
        offset_[i] += s16(9 + 2 * i) - (raw(i) + offset_[i]);
        offset_[i + 3] += s16(1 + 2 * i) - (turn[i] + offset_[i + 3]);
      }
      requested_ = false;
    } else {
      for (int i = 0; i < 3; ++i) currents[i] = 0.001 * s16(1 + 2 * static_cast<std::size_t>(i));
    }
    answer();
  }

  PolhemConfig config_;
  std::array<int, 6> offset_{};
  bool requested_ = false;
  double silent_ = 0.0;
};

}  // namespace pliant
