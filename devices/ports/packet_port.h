// A packet-based connection to a device: HID reports, USB transfers, datagrams, web socket messages. Drivers receive a
// function that opens one, so that tests can connect emulated firmware.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

class PacketPort {
 public:
  virtual ~PacketPort() = default;
  // Waits at most for the transmission of a packet. Error: the device is gone, or rejects it.
  virtual Status send(std::span<const std::uint8_t> packet) = 0;
  // Receives one packet into `into`, truncated to its size; returns its length, or 0 if none arrived within `seconds`
  // (0: at once). Error: the device is gone.
  virtual Result<std::size_t> receive(std::span<std::uint8_t> into, double seconds) = 0;
  // Reads HID feature report `number`, with its number first; returns its length. Fails for ports without feature
  // reports.
  virtual Result<std::size_t> feature(std::uint8_t number, std::span<std::uint8_t> into);
  virtual Status set_feature(std::span<const std::uint8_t> report);
  // File descriptor with which another process can switch the device off; -1: none.
  virtual int file() const { return -1; }
  // The device file that it is; "": none.
  virtual std::string node() const { return {}; }
  // The HID report descriptor; empty where there is none.
  virtual std::vector<std::uint8_t> descriptor() { return {}; }
};

using PortOpener = std::function<Result<std::unique_ptr<PacketPort>>(const std::string& id)>;

}  // namespace pliant
