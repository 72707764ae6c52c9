// The device side of a HID connection. Packets sent are queued for the host; the host's packets are recorded and
// answered at once. Nothing is allocated after construction, so that a driver's own allocations can be counted.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "devices/ports/packet_port.h"

namespace pliant {

struct EmulatedPacket {
  std::array<std::uint8_t, 128> bytes{};
  std::size_t length = 0;
  std::span<const std::uint8_t> view() const { return {bytes.data(), length}; }
};

struct EmulatedHid {
  static constexpr std::size_t kMost = 1u << 16;

  std::vector<std::uint8_t> descriptor;
  std::map<std::uint8_t, std::vector<std::uint8_t>> features;
  std::function<void(std::uint8_t)> on_feature = [](std::uint8_t) {};
  std::function<void(std::span<const std::uint8_t>)> on_packet = [](std::span<const std::uint8_t>) {};
  bool unplugged = false;
  int opened = 0;

  EmulatedHid() {
    waiting.reserve(kMost);
    heard.reserve(kMost);
  }
  void say(std::span<const std::uint8_t> bytes) {
    EmulatedPacket packet;
    packet.length = std::min(bytes.size(), packet.bytes.size());
    std::copy_n(bytes.begin(), packet.length, packet.bytes.begin());
    if (waiting.size() == kMost)
      waiting.erase(waiting.begin(), waiting.begin() + static_cast<std::ptrdiff_t>(next)), next = 0;
    waiting.push_back(packet);
  }

  std::vector<EmulatedPacket> waiting;  // from `next` on: not yet read by the host
  std::size_t next = 0;
  std::vector<EmulatedPacket> heard;  // packets from the host
};

class EmulatedPort final : public PacketPort {
 public:
  explicit EmulatedPort(EmulatedHid& device) : device_(device) { ++device_.opened; }
  Status send(std::span<const std::uint8_t> packet) override {
    if (device_.unplugged) return Error{"emulated", "is gone"};
    EmulatedPacket kept;
    kept.length = std::min(packet.size(), kept.bytes.size());
    std::copy_n(packet.begin(), kept.length, kept.bytes.begin());
    device_.heard.push_back(kept);
    device_.on_packet(packet);
    return Done{};
  }
  Result<std::size_t> receive(std::span<std::uint8_t> into, double) override {
    if (device_.unplugged) return Error{"emulated", "is gone"};
    if (device_.next == device_.waiting.size()) return std::size_t(0);
    const EmulatedPacket& packet = device_.waiting[device_.next++];
    const std::size_t length = std::min(packet.length, into.size());
    std::copy_n(packet.bytes.begin(), length, into.begin());
    return length;
  }
  Result<std::size_t> feature(std::uint8_t number, std::span<std::uint8_t> into) override {
    const auto found = device_.features.find(number);
    if (device_.unplugged || found == device_.features.end()) return Error{"emulated", "has no such feature report"};
    const std::size_t length = std::min(found->second.size(), into.size());
    std::copy_n(found->second.begin(), length, into.begin());
    device_.on_feature(number);
    return length;
  }
  std::vector<std::uint8_t> descriptor() override { return device_.descriptor; }

 private:
  EmulatedHid& device_;
};

inline PortOpener opener_of(EmulatedHid& device) {
  return [&device](const std::string&) -> Result<std::unique_ptr<PacketPort>> {
    if (device.unplugged) return Error{"emulated", "none is there; plug it in and switch it on"};
    return std::unique_ptr<PacketPort>(std::make_unique<EmulatedPort>(device));
  };
}

// A clock that a test moves.
struct EmulatedClock {
  double now = 100.0;  // [s]
  std::function<double()> function() {
    return [this] { return now; };
  }
};

inline void put_le16(std::span<std::uint8_t> bytes, std::size_t at, int value) {
  bytes[at] = static_cast<std::uint8_t>(value);
  bytes[at + 1] = static_cast<std::uint8_t>(value >> 8);
}

}  // namespace pliant
