// Exclusive access to a device: two writers to one motor would render neither's force. A claim holds within this
// program and against every other program of this engine on this machine, whatever its user. It is a name in the kernel
// (an abstract socket), needs no folder and no permission, and is released when the process ends.
#pragma once

#include <string>

#include "runtime/result.h"

namespace pliant {

class DeviceClaim {
 public:
  DeviceClaim() = default;
  ~DeviceClaim() { release(); }
  DeviceClaim(DeviceClaim&& other) noexcept;
  DeviceClaim& operator=(DeviceClaim&& other) noexcept;

  // `device`: "driver:id", in any spelling and with any wrappers (device_identity.h). Error: it is claimed already, or
  // the claim cannot be checked.
  Status take(const std::string& device);
  void release() noexcept;

 private:
  std::string device_;  // its identity
  int lock_ = -1;
};

}  // namespace pliant
