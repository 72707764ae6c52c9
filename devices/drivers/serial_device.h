// Driver "serial": a device of one's own on a serial line, such as an Arduino that reads encoders and drives motors
// (Hapkit, Haplink, ...). Those two publish no protocol between their board and a computer, only sketches that print
// numbers; so this one is ours (serial_line.h). "serial:/dev/ttyACM0" or "serial:/dev/ttyACM0@1000000"; 115200 baud
// where none is said.
//
// Each force line is answered by one pose line. A board that hears no force line for 20 ms must render nothing.
#pragma once

#include <string>
#include <vector>

#include "devices/drivers/device_thread.h"
#include "devices/drivers/serial_line.h"
#include "devices/ports/packet_port.h"

namespace pliant {

class SerialDevice final : public Driver {
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

  const std::string& name() const { return identity_.name; }

 private:
  Result<SerialIdentity> ask(PacketPort& port, const std::function<bool()>& stop) const;
  void run();
  bool talk();

  PortOpener opener_;
  std::string id_;
  SerialIdentity identity_;
  DeviceCapabilities can_;
  std::unique_ptr<PacketPort> port_;
  DeviceThread thread_;
};

// Serial lines of USB that are plugged in; they are not asked who they are, for a question may move a printer.
std::vector<DeviceInfo> list_serial(const std::string& folder = "/dev");

}  // namespace pliant
