#include "devices/ports/hid_descriptor.h"

#include <algorithm>

namespace pliant {
namespace {

constexpr std::uint32_t kMostBits = 8 * 65536;
constexpr std::size_t kMostFields = 4096, kDeepest = 32, kMostUsages = 1024;

// Tags of the items, with their type, without their size (HID 1.11, 6.2.2.4 to 6.2.2.8).
enum Item : std::uint8_t {
  kInputItem = 0x80,
  kOutputItem = 0x90,
  kFeatureItem = 0xb0,
  kCollection = 0xa0,
  kEndCollection = 0xc0,
  kUsagePage = 0x04,
  kLogicalMinimum = 0x14,
  kLogicalMaximum = 0x24,
  kReportSize = 0x74,
  kReportId = 0x84,
  kReportCount = 0x94,
  kPush = 0xa4,
  kPop = 0xb4,
  kUsage = 0x08,
  kUsageMinimum = 0x18,
  kUsageMaximum = 0x28,
};

struct Globals {
  std::uint16_t page = 0;
  std::int32_t min = 0;
  std::uint32_t max = 0;  // as written; its sign depends on that of the minimum
  std::uint32_t max_bytes = 0;
  std::uint32_t size = 0, count = 0;
  std::uint8_t report = 0;
};

struct Locals {
  std::vector<std::uint32_t> usages;  // page << 16 | usage
  std::uint32_t first = 0;
  bool has_first = false;
};

std::int32_t with_sign(std::uint32_t value, std::uint32_t bits) {
  if (bits >= 32 || bits == 0) return static_cast<std::int32_t>(value);
  const std::uint32_t sign = 1u << (bits - 1);
  return static_cast<std::int32_t>((value ^ sign) - sign);
}

Error broken(const char* what) {
  return Error{"HID report descriptor", std::string(what), "the device cannot be read"};
}

std::uint32_t& bits_of(HidLayout& layout, HidKind kind, std::uint8_t report) {
  for (HidLayout::Size& size : layout.sizes)
    if (size.kind == kind && size.report == report) return size.bits;
  layout.sizes.push_back({kind, report, 0});
  return layout.sizes.back().bits;
}

// Main item: `count` fields of `size` bits. Bit 0 of its flags: constant; bit 1: one field per number, no array.
Status add_fields(HidLayout& layout, const Globals& global, const Locals& local, HidKind kind, std::uint32_t flags) {
  std::uint32_t& bits = bits_of(layout, kind, global.report);
  if (global.size > kMostBits || global.count > kMostBits ||
      std::uint64_t(global.size) * global.count > kMostBits - bits)
    return broken("has a report of more than 64 kB");
  const bool is_constant = flags & 1, variable = flags & 2;
  for (std::uint32_t i = 0; i < global.count && !is_constant && variable && !local.usages.empty(); ++i) {
    if (global.size == 0 || global.size > 32 || layout.fields.size() >= kMostFields) break;
    const std::uint32_t usage = local.usages[std::min<std::size_t>(i, local.usages.size() - 1)];
    layout.fields.push_back({kind, global.report, bits + i * global.size, global.size,
                             static_cast<std::uint16_t>(usage >> 16), static_cast<std::uint16_t>(usage), global.min,
                             global.min < 0 ? with_sign(global.max, 8 * global.max_bytes)
                                            : static_cast<std::int32_t>(std::min(global.max, 0x7fffffffu))});
  }
  bits += global.size * global.count;
  return Done{};
}

}  // namespace

std::size_t HidLayout::bytes(HidKind kind, std::uint8_t report) const {
  for (const Size& size : sizes)
    if (size.kind == kind && size.report == report) return (size.bits + 7) / 8 + (numbered ? 1 : 0);
  return 0;
}

Result<HidLayout> parse_hid_descriptor(std::span<const std::uint8_t> descriptor) {
  HidLayout layout;
  Globals global;
  Locals local;
  std::vector<Globals> pushed;
  std::size_t depth = 0;
  for (std::size_t at = 0; at < descriptor.size();) {
    const std::uint8_t head = descriptor[at++];
    if (head == 0xfe) {  // a long item: its size, tag and data
      if (descriptor.size() - at < 2 || descriptor.size() - at - 2 < descriptor[at]) return broken("is cut");
      at += 2u + descriptor[at];
      continue;
    }
    const std::uint32_t bytes = (head & 3) == 3 ? 4 : head & 3;
    if (descriptor.size() - at < bytes) return broken("is cut");
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < bytes; ++i) value |= std::uint32_t(descriptor[at + i]) << (8 * i);
    at += bytes;
    const auto usage = [&] { return bytes == 4 ? value : std::uint32_t(global.page) << 16 | (value & 0xffff); };
    bool is_main = false;
    Status added = Done{};
    switch (head & 0xfc) {
      case kInputItem:
        added = add_fields(layout, global, local, HidKind::kInput, value), is_main = true;
        break;
      case kOutputItem:
        added = add_fields(layout, global, local, HidKind::kOutput, value), is_main = true;
        break;
      case kFeatureItem:
        added = add_fields(layout, global, local, HidKind::kFeature, value), is_main = true;
        break;
      case kCollection:
        if (depth++ == kDeepest) return broken("nests too deep");
        if (depth == 1 && !local.usages.empty() && local.usages[0] >> 16 == 1)
          layout.applications.push_back(static_cast<std::uint16_t>(local.usages[0]));
        is_main = true;
        break;
      case kEndCollection:
        if (depth-- == 0) return broken("ends a collection that it did not begin");
        is_main = true;
        break;
      case kUsagePage:
        global.page = static_cast<std::uint16_t>(value);
        break;
      case kLogicalMinimum:
        global.min = with_sign(value, 8 * bytes);
        break;
      case kLogicalMaximum:
        global.max = value, global.max_bytes = bytes;
        break;
      case kReportSize:
        global.size = value;
        break;
      case kReportCount:
        global.count = value;
        break;
      case kReportId:
        if (value == 0 || value > 255) return broken("numbers a report 0 or above 255");
        global.report = static_cast<std::uint8_t>(value);
        layout.numbered = true;
        break;
      case kPush:
        if (pushed.size() == kDeepest) return broken("nests too deep");
        pushed.push_back(global);
        break;
      case kPop:
        if (pushed.empty()) return broken("pops what it did not push");
        global = pushed.back();
        pushed.pop_back();
        break;
      case kUsage:
        if (local.usages.size() < kMostUsages) local.usages.push_back(usage());
        break;
      case kUsageMinimum:
        local.first = usage(), local.has_first = true;
        break;
      case kUsageMaximum:
        if (local.has_first)
          for (std::uint64_t u = local.first; u <= usage() && local.usages.size() < kMostUsages; ++u)
            local.usages.push_back(static_cast<std::uint32_t>(u));
        local.has_first = false;
        break;
      default:
        break;  // units, physical ranges, strings: unused
    }
    if (!added) return added.error();
    if (is_main) local = {};
  }
  if (depth > 0) return broken("is cut");
  return layout;
}

bool hid_value(const HidLayout& layout, const HidField& field, std::span<const std::uint8_t> packet,
               std::int32_t& value) {
  if (layout.numbered) {
    if (packet.empty() || packet[0] != field.report) return false;
    packet = packet.subspan(1);
  }
  if (field.bits == 0 || field.bits > 32 || std::uint64_t(field.bit) + field.bits > 8 * packet.size()) return false;
  std::uint64_t bits = 0;
  const std::uint32_t first = field.bit / 8, last = (field.bit + field.bits - 1) / 8;
  for (std::uint32_t i = first; i <= last; ++i) bits |= std::uint64_t(packet[i]) << (8 * (i - first));
  bits >>= field.bit % 8;
  const auto plain = static_cast<std::uint32_t>(field.bits == 32 ? bits : bits & ((1ull << field.bits) - 1));
  value = field.min < 0 ? with_sign(plain, field.bits) : static_cast<std::int32_t>(plain);
  return true;
}

}  // namespace pliant
