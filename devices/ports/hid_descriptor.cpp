#include "devices/ports/hid_descriptor.h"

#include <algorithm>
#include <utility>

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
  return Error{"HID report descriptor", std::string(what) + "; the device cannot be read"};
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

// Reads the items of a descriptor, one after the other.
class ItemReader {
 public:
  // `value` as stored in `bytes` bytes. Units, physical ranges and strings are unused.
  Status read(std::uint8_t item, std::uint32_t value, std::uint32_t bytes) {
    switch (item & 0x0c) {
      case 0x00:
        return read_main(item, value);
      case 0x04:
        return read_global(item, value, bytes);
      case 0x08:
        read_local(item, bytes == 4 ? value : std::uint32_t(global_.page) << 16 | (value & 0xffff));
    }
    return Done{};
  }
  bool complete() const { return depth_ == 0; }

  HidLayout layout;

 private:
  // An unused main item leaves the local ones.
  Status read_main(std::uint8_t item, std::uint32_t flags) {
    Status added = Done{};
    switch (item) {
      case kInputItem:
        added = add_fields(layout, global_, local_, HidKind::kInput, flags);
        break;
      case kOutputItem:
        added = add_fields(layout, global_, local_, HidKind::kOutput, flags);
        break;
      case kFeatureItem:
        added = add_fields(layout, global_, local_, HidKind::kFeature, flags);
        break;
      case kCollection:
        if (depth_++ == kDeepest) return broken("nests too deep");
        if (depth_ == 1 && !local_.usages.empty() && local_.usages[0] >> 16 == 1)
          layout.applications.push_back(static_cast<std::uint16_t>(local_.usages[0]));
        break;
      case kEndCollection:
        if (depth_-- == 0) return broken("ends a collection that it did not begin");
        break;
      default:
        return Done{};
    }
    local_ = {};
    return added;
  }

  Status read_global(std::uint8_t item, std::uint32_t value, std::uint32_t bytes) {
    switch (item) {
      case kUsagePage:
        global_.page = static_cast<std::uint16_t>(value);
        break;
      case kLogicalMinimum:
        global_.min = with_sign(value, 8 * bytes);
        break;
      case kLogicalMaximum:
        global_.max = value, global_.max_bytes = bytes;
        break;
      case kReportSize:
        global_.size = value;
        break;
      case kReportCount:
        global_.count = value;
        break;
      case kReportId:
        if (value == 0 || value > 255) return broken("numbers a report 0 or above 255");
        global_.report = static_cast<std::uint8_t>(value);
        layout.numbered = true;
        break;
      case kPush:
        if (pushed_.size() == kDeepest) return broken("nests too deep");
        pushed_.push_back(global_);
        break;
      case kPop:
        if (pushed_.empty()) return broken("pops what it did not push");
        global_ = pushed_.back();
        pushed_.pop_back();
    }
    return Done{};
  }

  void read_local(std::uint8_t item, std::uint32_t usage) {
    switch (item) {
      case kUsage:
        if (local_.usages.size() < kMostUsages) local_.usages.push_back(usage);
        break;
      case kUsageMinimum:
        local_.first = usage, local_.has_first = true;
        break;
      case kUsageMaximum:
        if (local_.has_first)
          for (std::uint64_t u = local_.first; u <= usage && local_.usages.size() < kMostUsages; ++u)
            local_.usages.push_back(static_cast<std::uint32_t>(u));
        local_.has_first = false;
    }
  }

  Globals global_;
  Locals local_;
  std::vector<Globals> pushed_;
  std::size_t depth_ = 0;
};

}  // namespace

std::size_t HidLayout::bytes(HidKind kind, std::uint8_t report) const {
  for (const Size& size : sizes)
    if (size.kind == kind && size.report == report) return (size.bits + 7) / 8 + (numbered ? 1 : 0);
  return 0;
}

Result<HidLayout> parse_hid_descriptor(std::span<const std::uint8_t> descriptor) {
  ItemReader reader;
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
    if (const Status read = reader.read(head & 0xfc, value, bytes); !read) return read.error();
  }
  if (!reader.complete()) return broken("is cut");
  return std::move(reader.layout);
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
