#include "runtime/clock.h"

#include <pthread.h>
#include <sched.h>

#include <cmath>
#include <thread>

namespace pliant {

RealtimeClock::RealtimeClock(double rate_hz) : rate_(rate_hz) {}

Tick RealtimeClock::next() {
  using clock = std::chrono::steady_clock;
  if (!started_) {
    start_ = clock::now();
    started_ = true;
  } else {
    ++index_;
  }
  // Computed from the index: a period that is not a whole number of nanoseconds accumulates no error.
  const auto due = start_ + std::chrono::nanoseconds(std::llround(static_cast<double>(index_) * 1e9 / rate_));
  const auto now = clock::now();
  std::uint64_t late = 0;
  if (now < due) {
    std::this_thread::sleep_until(due);
  } else {
    late = static_cast<std::uint64_t>(std::chrono::duration<double>(now - due).count() * rate_);
    overruns_ += late;
    index_ += late;
  }
  const double dt = 1.0 / rate_;
  return {index_, dt, static_cast<double>(index_) * dt, static_cast<double>(late) * dt};
}

bool request_realtime_priority() {
  sched_param parameters{};
  parameters.sched_priority = 50;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace pliant
