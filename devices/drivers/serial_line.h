// The lines of the serial device, our protocol (docs/devices/protocols.md): text, for debugging by hand, with a
// checksum at its end. A codec of pure functions.
//
//   device:  P <ms> <x> <y> <z> <buttons> <grip>*<sum>     its pose
//   engine:  F <n> <x> <y> <z>*<sum>                       the force to render; n counts lines
//   engine:  ?*<sum>          device:  I <name> <axes> <newtons>*<sum>     its identity
//
// Numbers are integers: micrometres, millinewtons, milliseconds of the device's clock, thousandths of a grip. The sum
// is the XOR of all characters before '*', two hexadecimal digits. Axes are the world's: right-handed, Y up.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "pliant/driver.h"

namespace pliant {

struct SerialPose {
  DeviceSample sample;
  std::uint32_t time_ms = 0;  // of the device's clock
};
struct SerialIdentity {
  std::string name;        // without blanks
  int axes = 0;            // 1 to 3 that it renders: x, then y, then z
  double max_force = 0.0;  // [N]
};

// Why a line is rejected.
enum class SerialFault : std::uint8_t { kNone, kTooShort, kSum, kForm, kNumber };
std::optional<SerialPose> parse_serial_pose(std::string_view line, SerialFault* fault = nullptr);
std::optional<SerialIdentity> parse_serial_identity(std::string_view line);
// Writes the line with its end into `into`; returns its length. Missing axes get zero.
using SerialText = std::array<char, 64>;
std::size_t serial_force(unsigned number, const dvec3& force, SerialText& into);
std::string serial_question();

// Splits a stream into lines; drops the rest of a line that is too long.
class SerialLines {
 public:
  void add(std::string_view bytes);
  // The next line without its end. False: no complete line.
  bool next(std::string_view& line);

 private:
  std::array<char, 1024> bytes_{};
  std::size_t size_ = 0, taken_ = 0;
  bool skipping_ = false;
};

}  // namespace pliant
