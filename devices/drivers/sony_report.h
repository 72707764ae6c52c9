// Reports of Sony's controllers, DualSense (and Edge) and DualShock 4, by USB and Bluetooth. Pure functions between
// bytes and numbers. Facts are from public drivers; tested by emulation only.
//
// A Bluetooth report ends with a CRC32 (of zlib, little-endian) over a byte for its kind and all preceding bytes. The
// kind is 0xA1 for input, 0xA2 for output, 0xA3 for feature reports.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "pliant/math.h"

namespace pliant {

enum class SonyModel : std::uint8_t { kDualSense, kDualShock };

std::uint32_t sony_crc(std::uint8_t kind, std::span<const std::uint8_t> bytes);
// Writes the CRC over the last four bytes.
void seal_sony(std::uint8_t kind, std::span<std::uint8_t> report);

// The content of an input report.
struct SonyInput {
  std::array<double, 4> sticks{};  // [1] LX LY RX RY in [-1, 1]; right and towards the user positive
  double left = 0.0, right = 0.0;  // [1] triggers, 0 to 1
  std::uint32_t buttons = 0;       // SonyButton
  std::array<std::int16_t, 3> gyro{}, acceleration{};  // raw; right, up out of the face, towards the user
  std::uint32_t time = 0;     // [ticks] of the sensors' clock: 1/3 us (DualSense, 32 bits), 16/3 us (DualShock, 16)
  std::uint8_t sequence = 0;  // counts reports; DualShock: 6 bits
  double battery = 0.0;       // [1] 0 to 1
  bool charging = false;
};

enum SonyButton : std::uint32_t {
  kSquare = 1,
  kCross = 2,
  kCircle = 4,
  kTriangle = 8,
  kLeftShoulder = 0x10,
  kRightShoulder = 0x20,
  kLeftTrigger = 0x40,
  kRightTrigger = 0x80,
  kShare = 0x100,
  kOptions = 0x200,
  kLeftStick = 0x400,
  kRightStick = 0x800,
  kHome = 0x1000,
  kTouchpad = 0x2000,
  kHatUp = 0x10000,
  kHatRight = 0x20000,
  kHatDown = 0x40000,
  kHatLeft = 0x80000
};

enum class SonyParse : std::uint8_t { kSample, kOther, kShort, kCorrupt };

// kOther: another report, such as the short one that a controller sends by Bluetooth initially. kCorrupt: wrong CRC.
// `input` is set only for kSample.
SonyParse parse_sony(SonyModel model, bool bluetooth, std::span<const std::uint8_t> report, SonyInput& input);

// Conversion of raw motion to rad/s and m/s2.
struct SonyCalibration {
  dvec3 gyro_bias{0};           // raw
  dvec3 gyro_scale{0};          // [rad/s] per count
  dvec3 acceleration_bias{0};   // raw
  dvec3 acceleration_scale{0};  // [m/s2] per count
};
// Nominal sensor scales: 2000 deg/s at full scale, 8192 counts per g.
SonyCalibration nominal_calibration();
// From the feature report (0x05 of 41 bytes; DualShock by USB 0x02 of 37). Empty: it is short, corrupt, or implausible.
std::optional<SonyCalibration> parse_sony_calibration(SonyModel model, bool bluetooth,
                                                      std::span<const std::uint8_t> report);

// Output of a controller.
struct SonyOutput {
  std::uint8_t strong = 0, weak = 0;  // motors: low-pitched left, high-pitched right
  std::uint8_t resistance = 0;        // of the right trigger, 0 to 8; DualSense only
  bool operator==(const SonyOutput&) const = default;
};
inline constexpr std::uint8_t kMostResistance = 8;
inline constexpr std::size_t kLongestSonyOutput = 78;

// Writes the report into `into`; returns its length. `sequence` counts reports (DualSense by Bluetooth). `new_rumble`:
// firmware from 2.21 on, and every Edge, uses another flag for its motors.
std::size_t dualsense_output(const SonyOutput& output, bool bluetooth, bool new_rumble, std::uint8_t sequence,
                             std::span<std::uint8_t, kLongestSonyOutput> into);
std::size_t dualshock_output(const SonyOutput& output, bool bluetooth,
                             std::span<std::uint8_t, kLongestSonyOutput> into);

}  // namespace pliant
