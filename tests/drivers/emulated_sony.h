// A controller's firmware: it reports by its own clock, and validates and executes output reports.
#pragma once

#include <numbers>
#include <optional>

#include "devices/drivers/sony_report.h"
#include "tests/drivers/emulated_hid.h"

namespace pliant {

// The controller's motion and pose, in physical units.
struct EmulatedHold {
  std::array<double, 4> sticks{};                // [1]
  double left = 0.0, right = 0.0;                // [1]
  dvec3 turning{0};                              // [rad/s] right, up, towards the user
  dvec3 felt{0, 9.80665, 0};                     // [m/s2]
  std::array<std::uint8_t, 3> buttons{8, 0, 0};  // hat at rest
};

class EmulatedSony {
 public:
  EmulatedSony(SonyModel model, bool bluetooth, int firmware = 0x0220) : model_(model), bluetooth_(bluetooth) {
    const bool sense = model == SonyModel::kDualSense;
    // A minimal descriptor that distinguishes the transports: the long input report exists only by Bluetooth.
    hid.descriptor = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01,
                      0x85, 0x01, 0x75, 0x08, 0x95, std::uint8_t(bluetooth ? 9 : 63),
                      0x09, 0x30, 0x81, 0x02};
    const auto add = [&](std::initializer_list<std::uint8_t> more) {
      hid.descriptor.insert(hid.descriptor.end(), more);
    };
    if (bluetooth) add({0x85, std::uint8_t(sense ? 0x31 : 0x11), 0x95, 77, 0x09, 0x31, 0x81, 0x02});
    add({0xc0});
    full_ = !bluetooth;
    const std::uint8_t number = sense || bluetooth ? 0x05 : 0x02;
    std::vector<std::uint8_t>& calibration = hid.features[number];
    calibration.assign(number == 0x05 ? 41 : 37, 0);
    calibration[0] = number;
    const bool apart = !sense && bluetooth;
    for (std::size_t i = 0; i < 3; ++i) {
      put_le16(calibration, 1 + 2 * i, kGyroBias[i]);
      put_le16(calibration, apart ? 7 + 2 * i : 7 + 4 * i, kGyroEnd[i]);
      put_le16(calibration, apart ? 13 + 2 * i : 9 + 4 * i, -kGyroEnd[i]);
      put_le16(calibration, 23 + 4 * i, kFeltEnd[i] + kFeltBias[i]);
      put_le16(calibration, 25 + 4 * i, -kFeltEnd[i] + kFeltBias[i]);
    }
    put_le16(calibration, 19, 540);
    put_le16(calibration, 21, 540);
    if (bluetooth) seal_sony(0xa3, calibration);
    if (sense) {
      std::vector<std::uint8_t>& version = hid.features[0x20];
      version.assign(64, 0);
      version[0] = 0x20;
      put_le16(version, 44, firmware);
      new_rumble_ = firmware >= 0x0215;
    }
    hid.on_feature = [this](std::uint8_t) { full_ = true; };
    hid.on_packet = [this](std::span<const std::uint8_t> packet) { hear(packet); };
  }

  // The next report, `seconds` after the last by the controller's own clock.
  std::vector<std::uint8_t> report(const EmulatedHold& hold, double seconds) {
    const bool sense = model_ == SonyModel::kDualSense;
    if (!full_) return {1, 128, 128, 128, 128, 8, 0, 0, 0, 0};  // the simple one
    seconds_ += seconds;
    ++sequence_;
    std::vector<std::uint8_t> bytes(bluetooth_ ? 78 : 64, 0);
    bytes[0] = !bluetooth_ ? 0x01 : sense ? 0x31 : 0x11;
    const std::span body = std::span(bytes).subspan(!bluetooth_ ? 1 : sense ? 2 : 3);
    for (std::size_t i = 0; i < 4; ++i) body[i] = static_cast<std::uint8_t>(std::lround(128 + 127 * hold.sticks[i]));
    const auto trigger = [](double pulled) { return static_cast<std::uint8_t>(std::lround(255 * pulled)); };
    body[sense ? 4 : 7] = trigger(hold.left);
    body[sense ? 5 : 8] = trigger(hold.right);
    for (std::size_t i = 0; i < 3; ++i) body[(sense ? 7 : 4) + i] = hold.buttons[i];
    for (std::size_t i = 0; i < 3; ++i) {
      const int axis = static_cast<int>(i);
      const double a_degree = 2.0 * kGyroEnd[i] / 1080.0;
      put_le16(body, (sense ? 15 : 12) + 2 * i,
               static_cast<int>(std::lround(hold.turning[axis] * 180 / std::numbers::pi * a_degree)) + kGyroBias[i]);
      put_le16(body, (sense ? 21 : 18) + 2 * i,
               static_cast<int>(std::lround(hold.felt[axis] / 9.80665 * kFeltEnd[i])) + kFeltBias[i]);
    }
    if (sense) {
      body[6] = static_cast<std::uint8_t>(sequence_);
      const auto ticks = static_cast<std::uint32_t>(static_cast<std::uint64_t>(std::llround(seconds_ * 3e6)) + start_);
      put_le16(body, 27, static_cast<int>(ticks & 0xffff));
      put_le16(body, 29, static_cast<int>(ticks >> 16));
      body[52] = 0x07;
    } else {
      body[6] = static_cast<std::uint8_t>(body[6] | sequence_ << 2);
      put_le16(body, 9,
               static_cast<int>(static_cast<std::uint64_t>(std::llround(seconds_ * 3e6 / 16)) + start_) & 0xffff);
      body[29] = 0x17;
    }
    if (bluetooth_) seal_sony(0xa1, bytes);
    return bytes;
  }
  void hold(const EmulatedHold& hold, double seconds) { hid.say(report(hold, seconds)); }

  // Current output of its motors and trigger.
  int strong = 0, weak = 0, resistance = 0;
  int refused = 0;  // packets with a wrong number, length, sum or sequence
  EmulatedHid hid;

  static constexpr std::array<int, 3> kGyroBias{3, -5, 2}, kGyroEnd{8800, 8900, 8700}, kFeltEnd{8200, 8100, 8300},
      kFeltBias{40, -30, 20};

 private:
  // Reads as the firmware does, from the published layout alone: not by the code under test.
  void hear(std::span<const std::uint8_t> packet) {
    const bool sense = model_ == SonyModel::kDualSense;
    const std::size_t length = sense ? (bluetooth_ ? 78 : 48) : (bluetooth_ ? 78 : 32);
    const std::uint8_t number = sense ? (bluetooth_ ? 0x31 : 0x02) : (bluetooth_ ? 0x11 : 0x05);
    bool good = packet.size() == length && packet[0] == number;
    if (good && bluetooth_) {
      std::array<std::uint8_t, 78> sum{};
      std::copy(packet.begin(), packet.end(), sum.begin());
      seal_sony(0xa2, sum);
      good = std::equal(sum.begin(), sum.end(), packet.begin());
      if (sense) {
        good = good && packet[1] >> 4 == (heard_ & 0xf) && packet[2] == 0x10;
        ++heard_;
      } else {
        good = good && packet[1] == 0xc0;
      }
    }
    if (!good) {
      ++refused;
      return;
    }
    const std::span<const std::uint8_t> common = packet.subspan(bluetooth_ ? 3 : 1);
    if (!sense) {
      if (common[0] & 1) weak = common[3], strong = common[4];
      return;
    }
    const bool motors = new_rumble_ ? common[38] & 4 : common[0] & 1;
    if (motors && common[0] & 2) weak = common[2], strong = common[3];
    if (common[0] & 4) {
      resistance = 0;
      const std::uint32_t zones = common[11] | common[12] << 8;
      const std::uint32_t strengths =
          common[13] | common[14] << 8 | common[15] << 16 | static_cast<std::uint32_t>(common[16]) << 24;
      if (common[10] == 0x21 && zones == 0x3ff) resistance = static_cast<int>(strengths & 7) + 1;
      if (common[10] != 0x21 && common[10] != 0x05) ++refused;
      for (int zone = 0; zone < 10; ++zone)
        if (resistance > 0 && static_cast<int>(strengths >> (3 * zone) & 7) + 1 != resistance) ++refused;
    }
  }

  SonyModel model_;
  bool bluetooth_, full_ = true, new_rumble_ = false;
  double seconds_ = 0.0;
  std::uint64_t start_ = 0xfffff000;  // its clock wraps soon
  unsigned sequence_ = 250, heard_ = 0;
};

}  // namespace pliant
