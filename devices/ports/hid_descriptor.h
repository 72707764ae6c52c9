// The HID report descriptor (USB HID 1.11, section 6.2.2): the meaning of the bits of each report.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/result.h"

namespace pliant {

enum class HidKind : std::uint8_t { kInput, kOutput, kFeature };

// One number in a report.
struct HidField {
  HidKind kind = HidKind::kInput;
  std::uint8_t report = 0;        // its report's number; 0: reports have none
  std::uint32_t bit = 0;          // start bit, after the number
  std::uint32_t bits = 0;         // 1 to 32
  std::uint16_t page = 0;         // usage page: 1 generic desktop, 9 buttons
  std::uint16_t usage = 0;        // on it: 0x30 X to 0x35 Rz; the number of a button
  std::int32_t min = 0, max = 0;  // logical range
};

struct HidLayout {
  std::vector<HidField> fields;             // those with a usage; padding and arrays are left out
  std::vector<std::uint16_t> applications;  // usages of the top collections, page 1 only: 5 game pad, 8 multi-axis
  bool numbered = false;                    // a report begins with its number
  // Size of a report, including its number; 0: not in the descriptor.
  std::size_t bytes(HidKind kind, std::uint8_t report) const;

  struct Size {
    HidKind kind;
    std::uint8_t report;
    std::uint32_t bits;
  };
  std::vector<Size> sizes;
};

// Error: a descriptor that is truncated, nests too deep, or is too large (64 kB of report).
Result<HidLayout> parse_hid_descriptor(std::span<const std::uint8_t> descriptor);

// The value of `field` in `packet` (a whole report, including its number if used), signed if its range has negative
// numbers. False: it is beyond the packet's end, or in another report.
bool hid_value(const HidLayout& layout, const HidField& field, std::span<const std::uint8_t> packet,
               std::int32_t& value);

}  // namespace pliant
