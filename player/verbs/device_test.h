// `pliant devices --test ID`: what a device senses, live; and, once that has been confirmed, a gentle push along each
// axis.
#pragma once

#include <string>

namespace pliant {

struct DeviceTestOptions {
  std::string id;         // as `pliant devices` prints it (devices/choose.h)
  double seconds = 10.0;  // how long it is looked at [s]
  bool push = false;      // asks, and then pushes
};
int test_device(const DeviceTestOptions& options);

}  // namespace pliant
