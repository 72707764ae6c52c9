// One device, one writer: two that write to one motor are felt as neither's force. A claim holds within this program
// and against every other program of this engine on this machine, whoever runs it: it is a name in the kernel (an
// abstract socket), which needs no folder and no permission, and goes with the process that has it.
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

  // `device`: "driver:id", in any spelling and with any wrappers (device_identity.h). Fails where somebody has it, and
  // where that cannot be known.
  Status take(const std::string& device);
  void release() noexcept;

 private:
  std::string device_;  // its identity
  int lock_ = -1;
};

}  // namespace pliant
