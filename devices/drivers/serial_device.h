// Driver "serial": a custom device on a serial port, such as an Arduino that reads encoders and drives motors (Hapkit,
// Haplink, ...). Those two publish no protocol, only sketches that print numbers, so this protocol is ours
// (serial_line.h). "serial:/dev/ttyACM0" or "serial:/dev/ttyACM0@1000000"; default 115200 baud.
//
// Each force line is answered by one pose line. Watchdog: a board without a force line for 20 ms must render zero.
#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "devices/drivers/device_thread.h"
#include "devices/drivers/safe_file.h"
#include "devices/drivers/serial_line.h"
#include "devices/ports/packet_port.h"
#include "pliant/device_state.h"

namespace pliant {

class SerialDevice final : public Driver, public CountsDropped {
 public:
  SerialDevice();
  explicit SerialDevice(PortOpener opener);
  ~SerialDevice() override;
  Status open(const std::string& id) override;
  DeviceCapabilities capabilities() const override { return can_; }
  bool read(DeviceSample& sample) override { return thread_.read(sample); }
  void write(const DeviceWrench& wrench) override { thread_.write(wrench); }
  void close() override;
  void make_safe() noexcept override { thread_.switch_off(); }
  bool safe_line(SafeLine& line) const override;
  DroppedFrames dropped() const override;

  const std::string& name() const { return identity_.name; }

 private:
  Result<SerialIdentity> ask(PacketPort& port, const std::function<bool()>& stop) const;
  void run();
  bool talk();
  void count(SerialFault fault);

  PortOpener opener_;
  std::string id_;
  SerialIdentity identity_;
  DeviceCapabilities can_;
  std::unique_ptr<PacketPort> port_;
  SafeFile safe_file_;
  std::atomic<std::uint64_t> too_short_{0}, sums_{0}, forms_{0}, numbers_{0};  // lines that were not used
  DeviceThread thread_;
};

// USB serial ports that are plugged in. They are not queried, because a query may move a printer.
std::vector<DeviceInfo> list_serial(const std::string& folder = "/dev");

}  // namespace pliant
