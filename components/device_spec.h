// The words that name a device, taken apart in one place: "falcon:0|delay=5ms; any-force; mouse".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pliant {

// One alternative of them.
struct DeviceSpec {
  std::string driver;                 // "falcon"; or a kind: any-force, any-pose, any, mouse. Empty: it names none
  std::string id;                     // "0": all behind the first colon
  bool has_id = false;                // there is a colon
  std::vector<std::string> wrappers;  // "delay=5ms"
  // "falcon:0"
  std::string device() const { return has_id ? driver + ":" + id : driver; }
  // "falcon:0|delay=5ms"
  std::string words() const;
};

// In their order; at least one. Blanks around each part are dropped.
std::vector<DeviceSpec> parse_device_specs(std::string_view words);

}  // namespace pliant
