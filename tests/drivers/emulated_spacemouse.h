// A cap's firmware: three int16 in reports 1 and 2 (wired) or six in report 1 (newer and wireless), buttons in
// report 3.
#pragma once

#include "tests/drivers/emulated_hid.h"

namespace pliant {

inline std::vector<std::uint8_t> spacemouse_descriptor(bool six_in_one) {
  std::vector<std::uint8_t> bytes{0x05, 0x01, 0x09, 0x08, 0xa1, 0x01};  // generic desktop, multi-axis
  const auto add = [&](std::initializer_list<std::uint8_t> more) {
    for (const std::uint8_t byte : more) bytes.push_back(byte);
  };
  add({0xa1, 0x00, 0x85, 0x01, 0x16, 0xa2, 0xfe, 0x26, 0x5e, 0x01});  // report 1, -350 to 350
  add({0x36, 0x88, 0xfa, 0x46, 0x78, 0x05, 0x55, 0x0c, 0x65, 0x11});  // physical range, unit
  add({0x09, 0x30, 0x09, 0x31, 0x09, 0x32});                          // X Y Z
  if (six_in_one) {
    add({0x09, 0x33, 0x09, 0x34, 0x09, 0x35, 0x75, 0x10, 0x95, 0x06, 0x81, 0x06, 0xc0});
  } else {
    add({0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xc0});
    add({0xa1, 0x00, 0x85, 0x02, 0x09, 0x33, 0x09, 0x34, 0x09, 0x35});  // report 2: Rx Ry Rz
    add({0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xc0});
  }
  add({0xa1, 0x02, 0x85, 0x03, 0x05, 0x09, 0x19, 0x01, 0x29, 0x02, 0x15, 0x00, 0x25, 0x01});  // report 3: two buttons
  add({0x75, 0x01, 0x95, 0x02, 0x81, 0x02, 0x95, 0x0e, 0x81, 0x03, 0xc0});
  add({0xa1, 0x02, 0x85, 0x04, 0x05, 0x08, 0x09, 0x4b, 0x15, 0x00, 0x25, 0x01, 0x95, 0x01, 0x75, 0x01, 0x91, 0x02});
  add({0x95, 0x01, 0x75, 0x07, 0x91, 0x03, 0xc0, 0xc0});  // report 4 out: the lamp
  return bytes;
}

class EmulatedSpaceMouse {
 public:
  explicit EmulatedSpaceMouse(bool six_in_one, bool described = true) : six_(six_in_one) {
    if (described) hid.descriptor = spacemouse_descriptor(six_in_one);
  }
  // The reports that a real one sends every 8 ms while its cap is deflected.
  void deflect(const std::array<int, 6>& counts) {
    std::array<std::uint8_t, 13> report{1};
    if (six_) {
      for (std::size_t i = 0; i < 6; ++i) put_le16(report, 1 + 2 * i, counts[i]);
      hid.say(report);
      return;
    }
    for (std::size_t half = 0; half < 2; ++half) {
      report[0] = static_cast<std::uint8_t>(1 + half);
      for (std::size_t i = 0; i < 3; ++i) put_le16(report, 1 + 2 * i, counts[3 * half + i]);
      hid.say(std::span(report).first(7));
    }
  }
  void press(int mask) { hid.say(std::array<std::uint8_t, 3>{3, static_cast<std::uint8_t>(mask), 0}); }

  EmulatedHid hid;

 private:
  bool six_;
};

}  // namespace pliant
