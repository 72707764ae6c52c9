#include "devices/servo/device_identity.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "devices/spec.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using Address = std::array<std::uint8_t, 16>;  // IPv6, or IPv4 mapped into it

constexpr Address kMapped{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};

bool address_of(const sockaddr* from, Address& out) {
  if (from && from->sa_family == AF_INET) {
    out = kMapped;
    std::memcpy(out.data() + 12, &reinterpret_cast<const sockaddr_in*>(from)->sin_addr, 4);
    return true;
  }
  if (!from || from->sa_family != AF_INET6) return false;
  std::memcpy(out.data(), &reinterpret_cast<const sockaddr_in6*>(from)->sin6_addr, 16);
  return true;
}

bool mapped(const Address& a) {
  return std::equal(kMapped.begin(), kMapped.begin() + 12, a.begin());
}

// A loopback address, the unspecified one, or one of this machine's own: all reach the same ports.
bool is_here(const Address& a) {
  Address one{};
  if (a == one) return true;
  one[15] = 1;
  if (a == one) return true;
  if (mapped(a) && (a[12] == 127 || (a[12] | a[13] | a[14] | a[15]) == 0)) return true;
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return false;
  bool own = false;
  for (const ifaddrs* each = all; each && !own; each = each->ifa_next)
    if (Address its; address_of(each->ifa_addr, its)) own = its == a;
  freeifaddrs(all);
  return own;
}

std::string network_identity(const std::string& id) {
  const std::string text(trimmed(id.substr(0, id.find(','))));
  const std::size_t colon = text.rfind(':');
  std::string host = colon == std::string::npos ? "127.0.0.1" : text.substr(0, colon);
  std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  if (port.empty()) port = kNetworkPort;
  port.erase(0, std::min(port.find_first_not_of('0'), port.size() - 1));
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* list = nullptr;
  if (getaddrinfo(host.c_str(), nullptr, &hints, &list) != 0) return "network:" + text;
  Address address{};
  const bool known = address_of(list->ai_addr, address);
  freeaddrinfo(list);
  if (!known) return "network:" + text;
  if (is_here(address)) return "network:here:" + port;
  std::string numbers;
  for (const std::uint8_t byte : address) numbers += fmt::format("{:02x}", byte);
  return fmt::format("network:{}:{}", numbers, port);
}

// "hardware:../../devices/...": the device that a hidraw or event node belongs to, of which it may have several; "":
// `name` is no such node.
std::string hardware_behind(const std::string& name) {
  std::error_code none;
  const fs::path raw = fs::read_symlink("/sys/class/hidraw/" + name, none);  // ../../devices/.../hidraw/hidraw3
  if (!none) return "hardware:" + raw.parent_path().parent_path().string();
  const fs::path event = fs::read_symlink("/sys/class/input/" + name, none);  // ../../devices/.../input/input12/event7
  if (none) return {};
  // One that a program made has no device behind it.
  const fs::path input = event.parent_path(), device = input.parent_path().parent_path();
  const bool known =
      input.parent_path().filename() == "input" && fs::exists("/sys/class/input" / device / "subsystem", none);
  return "hardware:" + (known ? device : input).string();
}

// A serial number: the device file of the only HID device that has it.
std::string hid_identity(const std::string& serial) {
  if (serial.empty()) return {};
  std::vector<fs::path> found;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator("/sys/class/hidraw", none)) {
    std::ifstream words(entry.path() / "device/uevent");
    for (std::string line; std::getline(words, line);)
      if (line == "HID_UNIQ=" + serial) found.push_back("/dev" / entry.path().filename());
  }
  return found.size() == 1 ? node_identity(found.front().string()) : std::string();
}

}  // namespace

std::string node_identity(const std::string& path) {
  const fs::path node = fs::path(path).lexically_normal();
  std::error_code none;
  if (node.parent_path() == "/dev" || node.parent_path() == "/dev/input")
    if (std::string behind = hardware_behind(node.filename().string()); !behind.empty()) return behind;
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0) return {};
  if (!S_ISCHR(file.st_mode)) return fmt::format("file:{}:{}", file.st_dev, file.st_ino);
  if (const fs::path linked = fs::read_symlink(node, none); !none)
    if (std::string behind = hardware_behind(linked.filename().string()); !behind.empty()) return behind;
  return fmt::format("node:{}:{}", major(file.st_rdev), minor(file.st_rdev));
}

std::string device_identity(const std::string& device) {
  const std::string words(trimmed(std::string_view(device).substr(0, device.find('|'))));
  const std::size_t colon = words.find(':');
  const std::string driver(trimmed(words.substr(0, colon)));
  const std::string id(colon == std::string::npos ? std::string_view()
                                                  : trimmed(std::string_view(words).substr(colon + 1)));
  if (driver == "network") return network_identity(id);
  if (driver == "falcon" || driver == "simulated") return driver;  // its id is a file, or what it is to be like
  const std::size_t speed = driver == "serial" ? id.rfind('@') : std::string::npos;
  const std::string file = id.substr(0, std::min(speed, id.find_first_of(",?")));
  if (file.find('/') != std::string::npos)
    if (std::string identity = node_identity(file); !identity.empty()) return identity;
  if (std::string identity = hid_identity(file); !identity.empty()) return identity;
  return driver + ":" + (file.empty() ? "0" : file);  // the first, which libraries count from 0
}

}  // namespace pliant
