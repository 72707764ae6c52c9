#include "runtime/clock.h"

#include <pthread.h>
#include <sched.h>

#include <thread>

namespace pliant {

RealtimeClock::RealtimeClock(double rate_hz) : period_(static_cast<std::int64_t>(1e9 / rate_hz)) {}

Tick RealtimeClock::next() {
  using clock = std::chrono::steady_clock;
  if (!started_) {
    start_ = clock::now();
    started_ = true;
  } else {
    ++index_;
  }
  const auto due = start_ + period_ * static_cast<std::int64_t>(index_);
  const auto now = clock::now();
  if (now < due) {
    std::this_thread::sleep_until(due);
  } else if (const std::int64_t late = (now - due) / period_; late > 0) {
    overruns_ += static_cast<std::uint64_t>(late);
    index_ += static_cast<std::uint64_t>(late);
  }
  const double dt = std::chrono::duration<double>(period_).count();
  return {index_, dt, static_cast<double>(index_) * dt};
}

bool request_realtime_priority() {
  sched_param parameters{};
  parameters.sched_priority = 50;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

}  // namespace pliant
