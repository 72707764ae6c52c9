// Bulk transfers to a USB device without a kernel driver, through libusb.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/ports/packet_port.h"

namespace pliant {

struct UsbAddress {
  std::uint16_t vendor = 0, product = 0;
  std::uint8_t out = 0, in = 0;  // endpoints
  int index = 0;                 // which of several
};

class UsbPort final : public PacketPort {
 public:
  // The error tells whether it is missing, not permitted, or in use.
  static Result<std::unique_ptr<UsbPort>> open(const UsbAddress& address);
  // How many are connected.
  static int count(std::uint16_t vendor, std::uint16_t product);
  ~UsbPort() override;
  Status send(std::span<const std::uint8_t> packet) override;
  Result<std::size_t> receive(std::span<std::uint8_t> into, double seconds) override;
  // A control request of the vendor, without data: request, value (low, high), index (low, high).
  Status set_feature(std::span<const std::uint8_t> request) override;

 private:
  struct Handles;
  explicit UsbPort(std::unique_ptr<Handles> handles);
  std::unique_ptr<Handles> handles_;
};

}  // namespace pliant
