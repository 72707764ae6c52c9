// `pliant devices --test ID`: prints the device's samples live and, after a confirmation, pushes gently along each
// axis.
#pragma once

#include <string>

namespace pliant {

struct DeviceTestOptions {
  std::string id;         // as `pliant devices` prints it (devices/choose.h)
  double seconds = 10.0;  // [s] duration of the display
  bool push = false;      // push after a confirmation
};
int test_device(const DeviceTestOptions& options);

}  // namespace pliant
