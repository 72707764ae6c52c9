#include "devices/drivers/sony_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pliant {
namespace {

constexpr std::uint8_t kInputKind = 0xa1, kOutputKind = 0xa2, kFeatureKind = 0xa3;
constexpr double kGravityOfReport = 9.80665;  // [m/s2]
constexpr double kDegree = std::numbers::pi / 180.0;

std::uint16_t u16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}
std::int16_t s16(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::int16_t>(u16(bytes, at));
}
std::uint32_t u32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return u16(bytes, at) | std::uint32_t(u16(bytes, at + 2)) << 16;
}

bool sealed(std::uint8_t kind, std::span<const std::uint8_t> report) {
  const std::size_t length = report.size() - 4;
  return sony_crc(kind, report.first(length)) == u32(report, length);
}

constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    table[i] = crc;
  }
  return table;
}();

double stick(std::uint8_t raw) {
  return std::clamp((raw - 128) / 127.0, -1.0, 1.0);
}

// Three bytes: hat and face buttons; shoulders and others; home and touchpad.
std::uint32_t buttons_of(std::span<const std::uint8_t> bytes) {
  static constexpr std::uint32_t kHat[] = {kHatUp,   kHatUp | kHatRight,  kHatRight, kHatRight | kHatDown,
                                           kHatDown, kHatDown | kHatLeft, kHatLeft,  kHatLeft | kHatUp};
  const std::uint32_t hat = bytes[0] & 0xf;
  return (hat < 8 ? kHat[hat] : 0u) | std::uint32_t(bytes[0] >> 4) | std::uint32_t(bytes[1]) << 4 |
         std::uint32_t(bytes[2] & 3) << 12;
}

void parse_dualsense(std::span<const std::uint8_t> body, SonyInput& input) {
  for (std::size_t i = 0; i < 4; ++i) input.sticks[i] = stick(body[i]);
  input.left = body[4] / 255.0;
  input.right = body[5] / 255.0;
  input.sequence = body[6];
  input.buttons = buttons_of(body.subspan(7));
  for (std::size_t i = 0; i < 3; ++i) {
    input.gyro[i] = s16(body, 15 + 2 * i);
    input.acceleration[i] = s16(body, 21 + 2 * i);
  }
  input.time = u32(body, 27);
  const std::uint8_t status = body[52], charge = status >> 4;
  input.battery = charge == 2 ? 1.0 : std::min(status & 0xf, 10) / 10.0;
  input.charging = charge == 1 || charge == 2;
}

void parse_dualshock(std::span<const std::uint8_t> body, SonyInput& input) {
  for (std::size_t i = 0; i < 4; ++i) input.sticks[i] = stick(body[i]);
  input.buttons = buttons_of(body.subspan(4));
  input.sequence = body[6] >> 2;
  input.left = body[7] / 255.0;
  input.right = body[8] / 255.0;
  input.time = u16(body, 9);
  for (std::size_t i = 0; i < 3; ++i) {
    input.gyro[i] = s16(body, 12 + 2 * i);
    input.acceleration[i] = s16(body, 18 + 2 * i);
  }
  const std::uint8_t status = body[29];
  input.charging = status & 0x10;
  input.battery = std::min((status & 0xf) / (input.charging ? 10.0 : 8.0), 1.0);
}

}  // namespace

std::uint32_t sony_crc(std::uint8_t kind, std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xffffffffu;
  const auto add = [&](std::uint8_t byte) { crc = kCrcTable[(crc ^ byte) & 0xff] ^ crc >> 8; };
  add(kind);
  for (const std::uint8_t byte : bytes) add(byte);
  return ~crc;
}

void seal_sony(std::uint8_t kind, std::span<std::uint8_t> report) {
  const std::size_t length = report.size() - 4;
  const std::uint32_t crc = sony_crc(kind, report.first(length));
  for (std::size_t i = 0; i < 4; ++i) report[length + i] = static_cast<std::uint8_t>(crc >> (8 * i));
}

SonyParse parse_sony(SonyModel model, bool bluetooth, std::span<const std::uint8_t> report, SonyInput& input) {
  const bool sense = model == SonyModel::kDualSense;
  const std::uint8_t number = !bluetooth ? 0x01 : sense ? 0x31 : 0x11;
  const std::size_t size = bluetooth ? 78 : 64, body = !bluetooth ? 1 : sense ? 2 : 3;
  if (report.empty() || report[0] != number) return SonyParse::kOther;
  if (report.size() < size) return SonyParse::kShort;
  report = report.first(size);
  if (bluetooth && !sealed(kInputKind, report)) return SonyParse::kCorrupt;
  if (sense)
    parse_dualsense(report.subspan(body), input);
  else
    parse_dualshock(report.subspan(body), input);
  return SonyParse::kSample;
}

SonyCalibration nominal_calibration() {
  SonyCalibration nominal;
  nominal.gyro_scale = dvec3(2000.0 / 32768.0 * kDegree);
  nominal.acceleration_scale = dvec3(kGravityOfReport / 8192.0);
  return nominal;
}

std::optional<SonyCalibration> parse_sony_calibration(SonyModel model, bool bluetooth,
                                                      std::span<const std::uint8_t> report) {
  const bool shock_usb = model == SonyModel::kDualShock && !bluetooth;
  const std::size_t size = shock_usb ? 37 : 41;
  if (report.size() < size || report[0] != (shock_usb ? 0x02 : 0x05)) return std::nullopt;
  report = report.first(size);
  if (bluetooth && !sealed(kFeatureKind, report)) return std::nullopt;
  // DualShock by Bluetooth: three positive limits, then three negative ones; otherwise they alternate.
  const bool apart = model == SonyModel::kDualShock && bluetooth;
  const double speed = s16(report, 19) + s16(report, 21);  // [deg/s] between the two limits
  SonyCalibration calibration;
  for (std::size_t i = 0; i < 3; ++i) {
    const int axis = static_cast<int>(i);
    const double plus = s16(report, apart ? 7 + 2 * i : 7 + 4 * i);
    const double minus = s16(report, apart ? 13 + 2 * i : 9 + 4 * i);
    calibration.gyro_bias[axis] = s16(report, 1 + 2 * i);
    calibration.gyro_scale[axis] = speed / (plus - minus) * kDegree;
    const double up = s16(report, 23 + 4 * i), down = s16(report, 25 + 4 * i);
    calibration.acceleration_bias[axis] = 0.5 * (up + down);
    calibration.acceleration_scale[axis] = 2.0 * kGravityOfReport / (up - down);
  }
  // Rejects a calibration that differs from the nominal one by more than a factor of two.
  const SonyCalibration nominal = nominal_calibration();
  for (int axis = 0; axis < 3; ++axis) {
    const double gyro = calibration.gyro_scale[axis] / nominal.gyro_scale[axis];
    const double acceleration = calibration.acceleration_scale[axis] / nominal.acceleration_scale[axis];
    if (!(gyro > 0.5 && gyro < 2.0 && acceleration > 0.5 && acceleration < 2.0)) return std::nullopt;
  }
  return calibration;
}

std::size_t dualsense_output(const SonyOutput& output, bool bluetooth, bool new_rumble, std::uint8_t sequence,
                             std::span<std::uint8_t, kLongestSonyOutput> into) {
  std::fill(into.begin(), into.end(), std::uint8_t(0));
  const std::size_t length = bluetooth ? 78 : 48;
  std::span<std::uint8_t> common = into.subspan(bluetooth ? 3 : 1, 47);
  into[0] = bluetooth ? 0x31 : 0x02;
  if (bluetooth) {
    into[1] = static_cast<std::uint8_t>(sequence << 4);
    into[2] = 0x10;
  }
  common[0] = static_cast<std::uint8_t>((new_rumble ? 0x00 : 0x01) | 0x02 | 0x04);  // motors, right trigger
  common[2] = output.weak;
  common[3] = output.strong;
  common[38] = new_rumble ? 0x04 : 0x00;
  const std::uint8_t resistance = std::min(output.resistance, kMostResistance);
  common[10] = resistance == 0 ? 0x05 : 0x21;
  if (resistance > 0) {  // all ten zones, three bits of strength each
    common[11] = 0xff;
    common[12] = 0x03;
    std::uint32_t zones = 0;
    for (int zone = 0; zone < 10; ++zone) zones |= std::uint32_t(resistance - 1) << (3 * zone);
    for (std::size_t i = 0; i < 4; ++i) common[13 + i] = static_cast<std::uint8_t>(zones >> (8 * i));
  }
  if (bluetooth) seal_sony(kOutputKind, into.first(length));
  return length;
}

std::size_t dualshock_output(const SonyOutput& output, bool bluetooth,
                             std::span<std::uint8_t, kLongestSonyOutput> into) {
  std::fill(into.begin(), into.end(), std::uint8_t(0));
  const std::size_t length = bluetooth ? 78 : 32;
  into[0] = bluetooth ? 0x11 : 0x05;
  if (bluetooth) into[1] = 0xc0;  // HID, with CRC
  std::span<std::uint8_t> common = into.subspan(bluetooth ? 3 : 1, 10);
  common[0] = 0x01;  // motors
  common[3] = output.weak;
  common[4] = output.strong;
  if (bluetooth) seal_sony(kOutputKind, into.first(length));
  return length;
}

}  // namespace pliant
