// A watchdog process that outlives this one briefly. It shares the device's file descriptor and switches the force off
// when this process dies or its heartbeat stops (stopped, starved). For devices with a descriptor that another process
// may write to (Driver::safe_line): sockets, serial ports, hidraw, evdev.
#pragma once

#include <sys/types.h>

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

}  // namespace pliant
