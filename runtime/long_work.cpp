#include "runtime/long_work.h"

#include <algorithm>

#include "runtime/clock.h"
#include "runtime/log.h"

namespace pliant {
namespace {

constexpr std::uint64_t kBetweenTellings = 20'000'000, kBetweenLines = 1'000'000'000;  // [ns]

thread_local WatchedWork* watch_of_thread = nullptr;

}  // namespace

WatchedWork::WatchedWork(const OpenProgress& progress) : progress_(progress), before_(watch_of_thread) {
  if (progress_) watch_of_thread = this;
}
WatchedWork::~WatchedWork() {
  if (progress_) watch_of_thread = before_;
}

void begin_part(double from, double to) {
  if (!watch_of_thread) return;
  watch_of_thread->from_ = from;
  watch_of_thread->to_ = to;
}

LongWork::LongWork() : last_(now_ns()) {}

void LongWork::say(const std::string& doing, double done) {
  const std::uint64_t now = now_ns();
  if (WatchedWork* const watch = watch_of_thread) {
    watch->doing_ = doing;
    if (watch->reported_ > 0 && now - watch->reported_ < kBetweenTellings) return;
    watch->reported_ = now;
    const double share = watch->from_ + std::clamp(done, 0.0, 1.0) * (watch->to_ - watch->from_);
    watch->share_ = std::max(watch->share_, share);
    if (!watch->progress_(watch->share_, doing)) throw WorkStopped{};
    return;
  }
  if (now - last_ < kBetweenLines) return;
  last_ = now;
  log_sentence(LogLevel::kInfo, "still " + doing);
}

void check_in() {
  if (!watch_of_thread) return;
  const std::string doing = watch_of_thread->doing_;
  LongWork().say(doing);
}

}  // namespace pliant
