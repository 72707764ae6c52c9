// Driver "haply": Haply's Inverse3 through the Inverse Service of this machine (ws://localhost:10001, JSON 3.1 and
// later, docs.haply.co). The service answers each message with exactly one state, so a thread of the driver's own asks
// a thousand times a second; read() and write() only exchange the newest with it.
//
// The service's axes are right-handed with z up; world axes are x, z, -y of them. Metres, newtons.
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
  std::string device;     // its identifier; "": the message speaks of none
  DeviceSample sample;    // ready: there is a pose, and the device says that it is ready and calibrated
  dvec3 velocity{0};      // [m/s]
  bool has_grip = false;  // a VerseGrip turns the pose and has buttons
};

// The first Inverse3, or the one called `wanted`. The error: no JSON of this kind, or numbers that cannot be.
Result<HaplyState> parse_haply(std::string_view message, const std::string& wanted);
// Asks for the next state and applies `force` (world axes) [N]; `first` names the session.
std::string haply_command(const std::string& device, const dvec3& force, bool first);

class Haply final : public Driver {
 public:
  Haply();  // the service of this machine
  explicit Haply(PortOpener opener);
  ~Haply() override;
  // `id`: of the device; empty: the first.
  Status open(const std::string& id) override;
  DeviceCapabilities capabilities() const override;
  bool read(DeviceSample& sample) override;
  void write(const DeviceWrench& wrench) override;
  void close() override;
  bool safe_line(SafeLine& line) const override;  // a message of zero force

  std::uint64_t refused() const { return refused_; }    // messages that were not understood
  std::uint64_t restarts() const { return restarts_; }  // times that the service was lost and found again

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
