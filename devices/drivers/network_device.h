// Driver "network": a device over UDP that senses its pose and renders the local model itself (network_frame.h;
// docs/devices/protocols.md). Its id is the device's address: PORT, ADDRESS:PORT, or empty for port 17716 of this
// machine. It may be followed by ,key=FILE or ,key-env=NAME if both sides have a key (network_key.h).
//
// Watchdog on both sides: after 20 ms without a frame, the force is zero. While the device does not respond, it is
// reopened ten times a second, so that a restarted one is found automatically.
#pragma once

#include <array>
#include <memory>

#include "devices/drivers/network_frame.h"
#include "devices/ports/packet_port.h"
#include "devices/ports/seconds.h"
#include "devices/servo/device_identity.h"

namespace pliant {

class NetworkDevice final : public Driver, public CountsDropped {
 public:
  NetworkDevice();  // over UDP
  explicit NetworkDevice(PortOpener opener, SecondsClock clock = monotonic_seconds);

  Status open(const std::string& id) override;
  DeviceCapabilities capabilities() const override { return can_; }
  bool read(DeviceSample& sample) override;
  void write(const DeviceWrench& wrench) override;
  bool write_model(const DeviceModel& model, const DeviceWrench& wrench) override;
  void close() override;
  bool safe_line(SafeLine& line) const override;
  DroppedFrames dropped() const override { return counts_; }

  // For the thread that reads and writes.
  const FrameCounts& counts() const { return counts_; }
  double round_trip() const {
    return round_trip_;
  }  // [s] from a write to the newest sample that acknowledges it; 0:
     // none
  const StateFrame& state() const { return state_; }
  std::string name() const { return name_.data(); }

 private:
  Result<std::size_t> receive(NetworkFrame& frame, double seconds);
  void ask(double now);
  const FrameKey* key() const { return key_ ? &*key_ : nullptr; }
  bool silent(double now) const { return !heard_ || now - heard_at_ > kFrameSilence; }
  void send(NetworkFrame& frame, double now);
  void send_force(ForceFrame& force);
  void hear(double now);
  bool accept(const NetworkFrame& frame, double now);
  bool accept_state(const NetworkFrame& frame, double now);

  PortOpener opener_;
  SecondsClock clock_;
  std::unique_ptr<PacketPort> port_;
  std::optional<FrameKey> key_;
  DeviceCapabilities can_;
  std::array<char, 32> name_{};
  StateFrame state_;
  FrameCounts counts_;
  std::array<char, 64> busy_{};         // who currently uses the device
  std::uint32_t own_ = 0, device_ = 0;  // sessions; 0: unknown
  std::uint32_t heard_sequence_ = 0;
  SentTimes sent_;
  std::uint64_t heard_time_us_ = 0;  // on the device's clock
  bool heard_ = false, fresh_ = false;
  double heard_at_ = 0.0, opened_at_ = 0.0;  // [s]
  double clock_offset_ = 0.0;                // [s] our clock minus the device's
  double round_trip_ = 0.0;                  // [s]
};

// The device that answers on this machine's default port.
std::vector<DeviceInfo> list_network_devices();

}  // namespace pliant
