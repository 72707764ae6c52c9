// A serial line (USB CDC, FTDI, RS-232), raw, 8N1. What comes is a stream: a packet here is what has arrived.
#pragma once

#include <memory>
#include <string>

#include "devices/ports/packet_port.h"

namespace pliant {

class SerialPort final : public PacketPort {
 public:
  // `baud`: 9600 to 4000000, of those that the system has.
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
