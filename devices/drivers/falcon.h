// Driver "falcon": Novint Falcon over libusb (an FTDI chip, 0403:cb48). Its firmware must be loaded after each
// power-up. The user provides the vendor's file: "falcon:FILE", or falcon.bin in the user's data folder (see
// docs/devices/protocols.md). Protocol facts from libnifalcon (BSD).
//
// Axes are the world's: x right, y up, z towards the user; the origin is the middle of its workspace. Its pose is
// unknown until homing: the user pulls its handle all the way out and pushes it in.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "devices/drivers/device_thread.h"
#include "devices/ports/packet_port.h"

namespace pliant {

// An input report.
struct FalconReport {
  std::array<int, 3> count{};  // of the encoders
  unsigned homed = 0;          // one bit per leg
  unsigned buttons = 0;        // of its grip
};
inline constexpr std::size_t kFalconFrame = 16;
using FalconFrame = std::array<std::uint8_t, kFalconFrame>;
// Sixteen letters: '<', three counts of four nibbles, status, reserve, '>'.
FalconFrame falcon_command(const std::array<int, 3>& torque, bool homing, unsigned lights);
// The last complete frame in a stream of bytes; empty: none.
std::optional<FalconReport> parse_falcon(std::span<const std::uint8_t> bytes);
// Motor commands for a force [N] at a position [m] of falcon_delta.h. If one exceeds the limit, all are scaled
// together, which keeps the direction.
std::array<int, 3> falcon_motors(const dvec3& position, const dvec3& force);

class Falcon final : public Driver {
 public:
  Falcon();
  explicit Falcon(PortOpener opener);
  ~Falcon() override;
  Status open(const std::string& id) override;
  DeviceCapabilities capabilities() const override;
  bool read(DeviceSample& sample) override { return thread_.read(sample); }
  void write(const DeviceWrench& wrench) override { thread_.write(wrench); }
  void close() override;
  void make_safe() noexcept override { thread_.switch_off(); }

 private:
  enum class Answer : std::uint8_t { kReport, kNone, kGone };
  Result<std::unique_ptr<PacketPort>> connect(const std::vector<std::uint8_t>& firmware) const;
  Answer exchange(PacketPort& port, const std::array<int, 3>& torque, bool homing, FalconReport& report) const;
  void run();
  bool talk();

  PortOpener opener_;
  std::vector<std::uint8_t> firmware_;
  std::unique_ptr<PacketPort> port_;
  DeviceThread thread_;
};

std::vector<DeviceInfo> list_falcon();

}  // namespace pliant
