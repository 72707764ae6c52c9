// One device, one writer: two that write to one motor are felt as neither's force. A claim holds within this program,
// and by a locked file against others of this engine.
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

  // `device`: "driver:id". Fails where somebody has it.
  Status take(const std::string& device);
  void release() noexcept;

 private:
  std::string device_;
  int lock_ = -1;
};

}  // namespace pliant
