// HID devices through hidapi on Linux's hidraw: listing, and connecting to one.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "devices/ports/packet_port.h"

namespace pliant {

// Installed location of `devices/70-pliant.rules`.
inline constexpr const char* kUdevRules = "/usr/lib/udev/rules.d/70-pliant.rules";

// A kind of device, by its vendor's ids.
struct HidMatch {
  std::uint16_t vendor = 0;
  std::vector<std::uint16_t> products;  // empty: every one of the vendor
  std::uint16_t page = 0, usage = 0;    // of the interface; 0: any
};

// A connected device.
struct HidFound {
  std::string path;  // /dev/hidraw3
  std::string id;    // serial number; its path if it has none or two have the same
  std::string name;
  std::uint16_t vendor = 0, product = 0;
  bool bluetooth = false;
  std::string missing;   // why it cannot be opened and the remedy; empty: it can
  std::string hardware;  // DeviceInfo::hardware
};

// The connected devices, ordered by path. Opens each one briefly. From any thread.
std::vector<HidFound> find_hid(std::span<const HidMatch> matches);

// Opens the matching device with this id or path; empty id: the first that can be opened. After unplugging, a port
// stays dead; call again to reopen. Errors name what is missing.
Result<std::unique_ptr<PacketPort>> open_hid(std::span<const HidMatch> matches, const std::string& id);

// One sentence for an open() that failed with this errno.
std::string cure_for_open(const std::string& path, int error);

}  // namespace pliant
