// Which device a wish means, of those that are there: what a level's `id` and `--probe NAME=device:WISH` say.
//
// A wish is one or more alternatives, separated by ";": the first that can be opened holds. Each is
//   DRIVER or DRIVER:ID     a driver's first device, or the one of that id (as `pliant devices` prints it)
//   any-force               whatever pushes in three axes, the strongest first
//   any-pose                whatever senses position and rotation
//   any                     whatever there is; none of these three is ever a simulated device, one that whoever sends
//                           from a port says to be there (`network`), or one whose limits cannot be
//   mouse                   the mouse of the window
// What follows "|" in an alternative is handed on with it (devices/wrappers).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "pliant/driver.h"
#include "runtime/result.h"

namespace pliant {

struct DeviceChoice {
  std::string id;                  // "DRIVER:ID" to connect; empty: the mouse
  std::string name;                // as people call it
  std::vector<std::string> notes;  // why an earlier alternative does not hold
};

// "falcon:0"; of a driver that has one device, its name.
std::string full_id(const DeviceInfo& device);
// The error says of every alternative why it cannot be.
Result<DeviceChoice> choose_device(const std::string& wish, std::span<const DeviceInfo> there);

}  // namespace pliant
