// Resolves a request (a level's `id`, or `--probe NAME=device:REQUEST`) to one of the available devices.
//
// A request is one or more alternatives, separated by ";". The first one that can be opened is used. Each is
//   DRIVER or DRIVER:ID     a driver's first device, or the one with that id (as `pliant devices` prints it)
//   any-force               a device that renders force in three axes, the strongest first
//   any-pose                a device that senses position and rotation
//   any                     any device. These three never select a simulated device, one announced over a port
//                           (`network`), or one with implausible limits
//   mouse                   the mouse of the window
// Text after "|" in an alternative is passed on with it (devices/wrappers).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pliant/driver.h"
#include "runtime/result.h"

namespace pliant {

struct DeviceChoice {
  std::string id;                  // "DRIVER:ID" to connect; empty: the mouse
  std::string name;                // display name
  std::vector<std::string> notes;  // why an earlier alternative was not used
};

// "falcon:0"; for a driver with a single device, its name.
std::string full_id(const DeviceInfo& device);
// The error tells for every alternative why it is not available.
Result<DeviceChoice> choose_device(const std::string& request, std::span<const DeviceInfo> there);

}  // namespace pliant
