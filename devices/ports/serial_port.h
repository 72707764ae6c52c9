// A serial port (USB CDC, FTDI, RS-232), raw, 8N1. Its input is a stream: a packet is whatever has arrived.
#pragma once

#include <memory>
#include <string>

#include "devices/ports/packet_port.h"

namespace pliant {

class SerialPort final : public PacketPort {
 public:
  // `baud`: 9600 to 4000000, if the system supports it.
  static Result<std::unique_ptr<SerialPort>> open(const std::string& path, int baud);
  ~SerialPort() override;
  Status send(std::span<const std::uint8_t> packet) override;
  Result<std::size_t> receive(std::span<std::uint8_t> into, double seconds) override;
  int file() const override { return file_; }

 private:
  SerialPort(int file, std::string path) : file_(file), path_(std::move(path)) {}
  int file_;
  std::string path_;
};

}  // namespace pliant
