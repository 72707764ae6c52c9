// Input from HID devices and gamepads: report descriptors, reports, feature reports, events. The first byte selects the
// parser. A driver's output must never be NaN or out of range.
#include <linux/input.h>

#include <cmath>
#include <cstdlib>
#include <span>

#include "devices/drivers/gamepad.h"
#include "devices/drivers/motion_filter.h"
#include "devices/drivers/polhem.h"
#include "devices/drivers/sony_report.h"
#include "devices/drivers/spacemouse.h"

namespace {

using namespace pliant;
using Bytes = std::span<const std::uint8_t>;

void check(bool holds) {
  if (!holds) std::abort();
}

// Length, then that many bytes; the last packet may be shorter.
Bytes next_packet(Bytes& rest) {
  if (rest.empty()) return {};
  const std::size_t length = std::min<std::size_t>(rest[0], rest.size() - 1);
  const Bytes packet = rest.subspan(1, length);
  rest = rest.subspan(1 + length);
  return packet;
}

void fuzz_spacemouse(const SpaceMouseLayout& layout, Bytes rest) {
  SpaceMouseState state;
  while (!rest.empty()) {
    parse_spacemouse(layout, next_packet(rest), state);
    for (const double axis : state.axes) check(std::abs(axis) <= 1.0);
  }
}

void fuzz_descriptor(Bytes bytes) {
  if (bytes.size() < 2) return;
  const std::size_t length = std::min<std::size_t>(bytes[0] | bytes[1] << 8, bytes.size() - 2);
  const Bytes descriptor = bytes.subspan(2, length), packet = bytes.subspan(2 + length);
  const Result<HidLayout> layout = parse_hid_descriptor(descriptor);
  if (!layout) return;
  for (const HidField& field : layout->fields) {
    std::int32_t value = 0;
    (void)hid_value(*layout, field, packet, value);
  }
  if (const Result<SpaceMouseLayout> cap = spacemouse_layout(descriptor)) fuzz_spacemouse(*cap, packet);
}

void fuzz_sony(SonyModel model, bool bluetooth, Bytes rest) {
  MotionFilter motion;
  const SonyCalibration nominal = nominal_calibration();
  while (!rest.empty()) {
    const Bytes packet = next_packet(rest);
    SonyInput input;
    std::vector<std::uint8_t> sealed(packet.begin(), packet.end());
    if (bluetooth && sealed.size() == 78) seal_sony(0xa1, sealed);  // a valid checksum lets the fuzzer reach the parser
    if (parse_sony(model, bluetooth, sealed, input) == SonyParse::kSample) {
      for (const double stick : input.sticks) check(std::abs(stick) <= 1.0);
      check(input.left >= 0.0 && input.left <= 1.0 && input.battery >= 0.0 && input.battery <= 1.0);
      motion.step(
          dvec3(input.gyro[0], input.gyro[1], input.gyro[2]) * nominal.gyro_scale,
          dvec3(input.acceleration[0], input.acceleration[1], input.acceleration[2]) * nominal.acceleration_scale,
          input.time * 1e-6);
      check(std::abs(length(motion.rotation()) - 1.0) < 1e-6);
    }
    if (bluetooth && sealed.size() >= 41) seal_sony(0xa3, std::span(sealed).first(41));
    if (const auto calibration = parse_sony_calibration(model, bluetooth, sealed))
      check(std::isfinite(length(calibration->gyro_scale)) && std::isfinite(length(calibration->acceleration_scale)));
  }
}

void fuzz_polhem(Bytes rest) {
  PolhemInput input;
  while (!rest.empty()) {
    if (!parse_polhem(next_packet(rest), input)) continue;
    for (const PolhemConfig& config : kPolhemConfigs) {
      check(std::isfinite(length(polhem_pose(config, input.counts).position)));
      const dvec3 currents = polhem_currents(config, polhem_angles(config, input.counts), {1, -20, 300});
      for (int motor = 0; motor < 3; ++motor) check(std::abs(currents[motor]) <= config.max_current * 1.000001);
    }
  }
}

void fuzz_gamepad(Bytes rest) {
  GamepadTraits traits;
  for (std::size_t i = 0; i < traits.axes.size(); ++i)
    traits.axes[i] = {i % 3 != 0, -static_cast<std::int32_t>(i) * 1000, i % 5 ? 0x7fffffff : -100000};
  for (std::uint16_t i = 0; i < 32; ++i) traits.keys[traits.key_count++] = static_cast<std::uint16_t>(BTN_JOYSTICK + i);
  GamepadParser parser(traits);
  for (; rest.size() >= 8; rest = rest.subspan(8)) {
    const auto u16 = [&](std::size_t at) { return static_cast<std::uint16_t>(rest[at] | rest[at + 1] << 8); };
    parser.take({u16(0), u16(2), static_cast<std::int32_t>(u16(4) | static_cast<std::uint32_t>(u16(6)) << 16)});
    for (std::uint16_t code = 0; code < 70; ++code) check(std::abs(parser.axis(code)) <= 1.0);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const Bytes rest(data + 1, size - 1);
  switch (data[0] % 8) {
    case 0:
      fuzz_descriptor(rest);
      break;
    case 1:
      fuzz_spacemouse(*spacemouse_layout({}), rest);
      break;
    case 2:
      fuzz_sony(SonyModel::kDualSense, false, rest);
      break;
    case 3:
      fuzz_sony(SonyModel::kDualSense, true, rest);
      break;
    case 4:
      fuzz_sony(SonyModel::kDualShock, false, rest);
      break;
    case 5:
      fuzz_sony(SonyModel::kDualShock, true, rest);
      break;
    case 6:
      fuzz_polhem(rest);
      break;
    default:
      fuzz_gamepad(rest);
      break;
  }
  return 0;
}
