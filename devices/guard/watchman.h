// A process that outlives this one by a moment: it holds the device's line too, and writes what switches the force off
// when this process dies, or has not been heard for a while (stopped, starved). For devices with a line that another
// process may write (Driver::safe_line): sockets, serial ports, hidraw, evdev.
#pragma once

#include <sys/types.h>

#include <string>

#include "pliant/driver.h"
#include "runtime/result.h"

namespace pliant {

inline constexpr double kWatchmanWaits = 0.050;  // [s] without a beat, then it writes

class Watchman {
 public:
  Watchman() = default;
  ~Watchman() { end(); }
  Watchman(const Watchman&) = delete;
  Watchman& operator=(const Watchman&) = delete;

  Status start(const SafeLine& line, double waits = kWatchmanWaits);
  bool watches() const { return child_ > 0; }
  // From the servo, as often as it likes: does not wait.
  void beat() noexcept;
  // Another line, or other bytes, from now on. Does not wait either; what does not get through is told again.
  void renew(const SafeLine& line) noexcept;
  void end() noexcept;  // in order: it writes nothing

 private:
  int pipe_ = -1;
  pid_t child_ = -1;
};

// The guard process of one driver that is open, told of the line that holds now.
class LineWatch {
 public:
  // A sentence for a person, where nothing outside this program can end a force that the driver renders; may be empty.
  std::string start(const Driver& driver, const DeviceCapabilities& can);
  // As often as forces are written. `now` [s] of any clock that goes on.
  void beat(const Driver& driver, double now) noexcept;
  void end() noexcept { watchman_.end(); }

 private:
  Watchman watchman_;
  double told_at_ = 0.0;  // [s] of the line
};

// Whether there is something to feel of a device.
bool renders(const DeviceCapabilities& can);

}  // namespace pliant
