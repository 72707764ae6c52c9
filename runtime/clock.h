// Time for a schedule. Lockstep is virtual time: tick n is at n*dt, independent of the machine. Real time: a thread
// wakes with a fixed period and counts the ticks that it could not begin in time.
#pragma once

#include <chrono>
#include <cstdint>

namespace pliant {

// One step of a clock.
struct Tick {
  std::uint64_t index = 0;  // 0, 1, 2, ...
  double dt = 1e-3;         // [s] length of the step
  double time = 0.0;        // [s] since the start, at the beginning of the step
  double skipped = 0.0;     // [s] total length of the ticks just before it that could not begin in time
  // [s] Time since the previous tick; external inputs moved during it.
  double elapsed() const { return dt + skipped; }
};

// Virtual time.
class LockstepClock {
 public:
  explicit LockstepClock(double rate_hz) : dt_(1.0 / rate_hz) {}
  Tick next() {
    const Tick tick{index_, dt_, static_cast<double>(index_) * dt_};
    ++index_;
    return tick;
  }

 private:
  double dt_;
  std::uint64_t index_ = 0;
};

// Wall time, for the thread that owns the clock. An overrun is a period that had already passed when its tick was
// requested. Overruns are counted and the missed ticks are skipped: virtual time jumps with wall time, so the world
// never runs slow.
class RealtimeClock {
 public:
  explicit RealtimeClock(double rate_hz);
  Tick next();  // sleeps until the next period begins
  std::uint64_t overruns() const { return overruns_; }

 private:
  double rate_;  // [Hz]
  std::chrono::steady_clock::time_point start_;
  std::uint64_t index_ = 0;
  std::uint64_t overruns_ = 0;
  bool started_ = false;
};

// Requests SCHED_FIFO for the calling thread. Returns false, without effect, where the system does not grant it.
bool request_realtime_priority();

// Monotonic nanoseconds for measuring durations.
inline std::uint64_t now_ns() {
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}
inline double ms_since(std::uint64_t begin_ns) {
  return static_cast<double>(now_ns() - begin_ns) * 1e-6;
}

}  // namespace pliant
