// Exclusive access to a device: two writers to one motor would render neither's force. A claim holds within this
// program and against every other program of this engine on this machine, whatever its user. It is a name in the kernel
// (an abstract socket), needs no folder and no permission, and is released when the process ends.
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

  // `device`: "driver:id", in any spelling and with any wrappers (device_identity.h). Error: it is claimed already, or
  // the claim cannot be checked.
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
