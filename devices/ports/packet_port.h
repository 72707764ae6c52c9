// A line to a device that keeps packets apart: HID reports, USB transfers, datagrams, messages of a web socket.
// Drivers are given a function that opens one, so that tests put an emulated firmware at the other end.
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
  // Waits no longer than a packet takes to leave. The error: the device is gone, or refuses.
  virtual Status send(std::span<const std::uint8_t> packet) = 0;
  // One packet into `into`, cut to its size; returns its length, and 0 where none came within `seconds` (0: now). The
  // error: the device is gone.
  virtual Result<std::size_t> receive(std::span<std::uint8_t> into, double seconds) = 0;
  // HID feature report `number`, its number first; the length that came. Lines without such a thing fail.
  virtual Result<std::size_t> feature(std::uint8_t number, std::span<std::uint8_t> into);
  virtual Status set_feature(std::span<const std::uint8_t> report);
  // What another process may write to as well, to switch the device off; -1: there is no such thing.
  virtual int file() const { return -1; }
  // The device file that it is; "": none.
  virtual std::string node() const { return {}; }
  // The HID report descriptor; empty where there is none.
  virtual std::vector<std::uint8_t> descriptor() { return {}; }
};

using PortOpener = std::function<Result<std::unique_ptr<PacketPort>>(const std::string& id)>;

}  // namespace pliant
