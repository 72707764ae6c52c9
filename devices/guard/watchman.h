// A watchdog process that outlives this one briefly. It shares the device's file descriptor and switches the force off
// when this process dies or its heartbeat stops (stopped, starved). For devices with a descriptor that another process
// may write to (Driver::safe_line): sockets, serial ports, hidraw, evdev.
#pragma once

#include <sys/types.h>

#include <string>

#include "pliant/driver.h"
#include "runtime/result.h"

namespace pliant {

inline constexpr double kWatchmanWaits = 0.050;  // [s] heartbeat time-out, after which it writes

class Watchman {
 public:
  Watchman() = default;
  ~Watchman() { end(); }
  Watchman(const Watchman&) = delete;
  Watchman& operator=(const Watchman&) = delete;

  Status start(const SafeLine& line, double waits = kWatchmanWaits);
  bool watches() const { return child_ > 0; }
  // Heartbeat, from the servo, at any rate; does not wait.
  void beat() noexcept;
  // Replaces the line or its bytes. Does not wait; a lost message is repeated later.
  void renew(const SafeLine& line) noexcept;
  void end() noexcept;  // normal end: the watchdog writes nothing

 private:
  int pipe_ = -1;
  pid_t child_ = -1;
};

// The guard process of one driver that is open, with the line that holds now.
class LineWatch {
 public:
  // A sentence for a person, where nothing outside this program can end a force that the driver renders; may be empty.
  std::string start(const Driver& driver, const DeviceCapabilities& can);
  // As often as forces are written. `now` [s] of any clock that goes on.
  void beat(const Driver& driver, double now) noexcept;
  void end() noexcept { watchman_.end(); }

 private:
  Watchman watchman_;
  double reported_at_ = 0.0;  // [s] of the line
};

// Whether there is something to feel of a device.
bool renders(const DeviceCapabilities& can);

}  // namespace pliant
