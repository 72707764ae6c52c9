// A process that outlives this one by a moment: it holds the device's line too, and writes what switches the force off
// when this process dies, or has not been heard for a while (stopped, starved). For devices with a line that another
// process may write (Driver::safe_line): sockets, serial ports, hidraw, evdev.
#pragma once

#include <sys/types.h>

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

}  // namespace pliant
