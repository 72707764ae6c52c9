// HID devices by hidapi over Linux's hidraw: what is there, and a line to one of them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "devices/ports/packet_port.h"

namespace pliant {

// Where `devices/70-pliant.rules` lies once it is installed.
inline constexpr const char* kUdevRules = "/usr/lib/udev/rules.d/70-pliant.rules";

// A kind of device, by the numbers that its maker gave it.
struct HidMatch {
  std::uint16_t vendor = 0;
  std::vector<std::uint16_t> products;  // empty: every one of the vendor
  std::uint16_t page = 0, usage = 0;    // of the interface; 0: any
};

// One that is there.
struct HidFound {
  std::string path;  // /dev/hidraw3
  std::string id;    // its serial number; without one, or where two have the same, its path
  std::string name;
  std::uint16_t vendor = 0, product = 0;
  bool bluetooth = false;
  std::string missing;   // why it cannot be opened and what to do; empty: it can
  std::string hardware;  // DeviceInfo::hardware
};

// What is there now, in the order of the paths. Opens each for an instant. From any thread.
std::vector<HidFound> find_hid(std::span<const HidMatch> matches);

// The device of this id or path among those that match; an empty id: the first that can be opened. A device that was
// unplugged is opened anew by another call: its line stays dead. Errors say what is missing.
Result<std::unique_ptr<PacketPort>> open_hid(std::span<const HidMatch> matches, const std::string& id);

// One sentence for an open() that failed with this errno.
std::string cure_for_open(const std::string& path, int error);

}  // namespace pliant
