// Driver "haply": Haply's Inverse3 through the local Inverse Service (ws://localhost:10001, JSON 3.1 and later,
// docs.haply.co). The service answers each message with exactly one state, so a separate thread sends a thousand
// messages a second. read() and write() only exchange the newest values with it.
//
// The service's axes are right-handed with z up; world axes are their x, z, -y. Metres, newtons.
#pragma once

#include <atomic>
#include <string>
#include <string_view>

#include "devices/drivers/device_thread.h"
#include "devices/drivers/safe_file.h"
#include "devices/ports/packet_port.h"

namespace pliant {

// One state message, in world axes.
struct HaplyState {
  std::string device;     // its identifier; "": the message contains no device
  DeviceSample sample;    // ready: there is a pose, and the device reports ready and calibrated
  dvec3 velocity{0};      // [m/s]
  bool has_grip = false;  // a VerseGrip gives rotation and buttons
};

// The first Inverse3, or the one named `wanted`. Error: not such JSON, or numbers out of range.
Result<HaplyState> parse_haply(std::string_view message, const std::string& wanted);
// Requests the next state and applies `force` (world axes) [N]; `first` configures the session.
std::string haply_command(const std::string& device, const dvec3& force, bool first);

class Haply final : public Driver {
 public:
  Haply();  // the local service
  explicit Haply(PortOpener opener);
  ~Haply() override;
  // `id`: device identifier; empty: the first.
  Status open(const std::string& id) override;
  DeviceCapabilities capabilities() const override;
  bool read(DeviceSample& sample) override;
  void write(const DeviceWrench& wrench) override;
  void close() override;
  bool safe_line(SafeLine& line) const override;  // a message of zero force

  std::uint64_t refused() const { return refused_; }    // messages that could not be parsed
  std::uint64_t restarts() const { return restarts_; }  // reconnections to the service

 private:
  void run();
  bool talk(PacketPort& port);

  PortOpener opener_;
  std::string wanted_;  // the device's identifier
  std::unique_ptr<PacketPort> port_;
  SafeFile safe_file_;
  bool has_grip_ = false;
  std::atomic<std::uint64_t> refused_{0}, restarts_{0};
  DeviceThread thread_;
};

std::vector<DeviceInfo> list_haply();

}  // namespace pliant
