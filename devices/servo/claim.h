// One device, one writer: two that write to one motor are felt as neither's force. A claim holds within this program
// and against every other program of this engine on this machine, whoever runs it: it is a name in the kernel (an
// abstract socket), which needs no folder and no permission, and goes with the process that has it.
#pragma once

#include <string>
#include <vector>

#include "pliant/driver.h"
#include "runtime/result.h"

namespace pliant {

class DeviceClaim {
 public:
  DeviceClaim() = default;
  ~DeviceClaim() { release(); }
  DeviceClaim(DeviceClaim&& other) noexcept = default;
  DeviceClaim& operator=(DeviceClaim&& other) noexcept;

  // `device`: "driver:id", in any spelling and with any wrappers (device_identity.h). Fails where somebody has it, and
  // where that cannot be known.
  Status take(const std::string& device);
  // Besides, what `driver` has opened under that name: "the first one" says it only then, and another driver may have
  // the same device under its own name.
  Status take_opened(const std::string& device, const Driver& driver);
  void release() noexcept;

 private:
  struct Held {
    std::string identity;
    int lock = -1;
  };
  Status add(const std::string& identity, const std::string& device);
  std::vector<Held> held_;
};

}  // namespace pliant
