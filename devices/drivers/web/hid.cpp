// HID devices of a browser (WebHID), in place of ports/hid_port.cpp: JavaScript opens them, and carries their reports
// in and out by the functions below (web/hid.js). A report begins with its number, 0 where the device has none.
#include <emscripten/emscripten.h>

#include <algorithm>
#include <deque>
#include <map>

#include "devices/ports/hid_port.h"
#include "devices/ports/newest_port.h"

namespace pliant {
namespace {

constexpr std::size_t kMostWaiting = 256;  // reports; older ones are dropped

using Bytes = std::vector<std::uint8_t>;

struct WebDevice {
  std::uint16_t vendor = 0, product = 0;
  std::string name;
  Bytes descriptor;
  std::deque<Bytes> in, out;
  std::map<std::uint8_t, Bytes> features;  // as read at opening
};

// By number; a device that was unplugged is not in it.
std::map<int, WebDevice>& devices() {
  static std::map<int, WebDevice> all;
  return all;
}

std::size_t copied(const Bytes& from, std::span<std::uint8_t> into) {
  const std::size_t length = std::min(from.size(), into.size());
  std::copy_n(from.begin(), length, into.begin());
  return length;
}

class WebPort final : public PacketPort {
 public:
  explicit WebPort(int number) : number_(number) {}

  Status send(std::span<const std::uint8_t> packet) override {
    WebDevice* const device = find();
    if (!device) return gone();
    if (device->out.size() >= kMostWaiting) device->out.pop_front();
    device->out.emplace_back(packet.begin(), packet.end());
    return Done{};
  }
  Result<std::size_t> receive(std::span<std::uint8_t> into, double) override {
    WebDevice* const device = find();
    if (!device) return gone();
    if (device->in.empty()) return std::size_t(0);
    const std::size_t length = copied(device->in.front(), into);
    device->in.pop_front();
    return length;
  }
  Result<std::size_t> feature(std::uint8_t number, std::span<std::uint8_t> into) override {
    WebDevice* const device = find();
    if (!device) return gone();
    const auto found = device->features.find(number);
    if (found == device->features.end()) return PacketPort::feature(number, into);
    return copied(found->second, into);
  }
  Bytes descriptor() override {
    WebDevice* const device = find();
    return device ? device->descriptor : Bytes{};
  }

 private:
  WebDevice* find() const {
    const auto found = devices().find(number_);
    return found == devices().end() ? nullptr : &found->second;
  }
  Error gone() const { return Error{"device", "is gone", "plug it in again, and connect it"}; }

  int number_;
};

bool fits(const WebDevice& device, std::span<const HidMatch> matches) {
  return std::any_of(matches.begin(), matches.end(), [&](const HidMatch& match) {
    return device.vendor == match.vendor &&
           (match.products.empty() ||
            std::find(match.products.begin(), match.products.end(), device.product) != match.products.end());
  });
}

}  // namespace

std::vector<HidFound> find_hid(std::span<const HidMatch> matches) {
  std::vector<HidFound> found;
  for (const auto& [number, device] : devices())
    if (fits(device, matches))
      found.push_back({std::to_string(number), std::to_string(number), device.name, device.vendor, device.product,
                       false, "", std::to_string(number)});
  return found;
}

Result<std::unique_ptr<PacketPort>> open_hid(std::span<const HidMatch> matches, const std::string& id) {
  for (const HidFound& found : find_hid(matches))
    if (id.empty() || id == found.id) return std::unique_ptr<PacketPort>(new WebPort(std::stoi(found.id)));
  return Error{id.empty() ? "device" : "device `" + id + "`", "is not there", "connect it in the page",
               "device.missing"};
}

// JavaScript sends a packet when it has time, so that no thread is needed.
std::unique_ptr<PacketPort> newest_port(std::unique_ptr<PacketPort> line) {
  return line;
}

}  // namespace pliant

extern "C" {

EMSCRIPTEN_KEEPALIVE void pliant_web_hid_add(int number, int vendor, int product, const char* name,
                                             const std::uint8_t* descriptor, std::size_t count) {
  pliant::WebDevice& device = pliant::devices()[number];
  device = {static_cast<std::uint16_t>(vendor),
            static_cast<std::uint16_t>(product),
            name,
            {descriptor, descriptor + count},
            {},
            {},
            {}};
}
EMSCRIPTEN_KEEPALIVE void pliant_web_hid_remove(int number) {
  pliant::devices().erase(number);
}

EMSCRIPTEN_KEEPALIVE void pliant_web_hid_report(int number, const std::uint8_t* bytes, std::size_t count) {
  const auto found = pliant::devices().find(number);
  if (found == pliant::devices().end()) return;
  if (found->second.in.size() >= pliant::kMostWaiting) found->second.in.pop_front();
  found->second.in.emplace_back(bytes, bytes + count);
}
EMSCRIPTEN_KEEPALIVE void pliant_web_hid_feature(int number, int report, const std::uint8_t* bytes, std::size_t count) {
  const auto found = pliant::devices().find(number);
  if (found != pliant::devices().end())
    found->second.features[static_cast<std::uint8_t>(report)] = {bytes, bytes + count};
}
// The next report to send; 0: none.
EMSCRIPTEN_KEEPALIVE std::size_t pliant_web_hid_take(int number, std::uint8_t* into, std::size_t capacity) {
  const auto found = pliant::devices().find(number);
  if (found == pliant::devices().end() || found->second.out.empty()) return 0;
  const std::size_t length = pliant::copied(found->second.out.front(), {into, capacity});
  found->second.out.pop_front();
  return length;
}
}
