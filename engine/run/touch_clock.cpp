#include "engine/run/touch_clock.h"

#include <exception>

#include "runtime/clock.h"
#include "systems/device/devices.h"

namespace pliant {
namespace {

constexpr const char* kReport = "; please report it with the level";
constexpr double kReportEvery = 0.1;  // [s] between published figures

}  // namespace

void let_go(World& world, Tick tick) {
  for (auto [entity, device] : world.registry.view<HapticDevice>()) device.status = DeviceStatus::kLost;
  write_devices(world, tick);
  for (auto [entity, device] : world.registry.view<HapticDevice>())  // also those that nothing moves
    device.force_sent = device.torque_sent = dvec3(0);
}

TouchClock::TouchClock(World& world, Schedule<World>& schedule, SoftClock* soft, double rate, std::uint64_t ticks,
                       TouchHooks hooks)
    : world_(world), schedule_(schedule), soft_(soft), rate_(rate), ticks_(ticks), hooks_(std::move(hooks)) {
  last_ = {0, 1.0 / rate, 0.0};
  for ([[maybe_unused]] auto [entity, device] : world.registry.view<HapticDevice>())
    before_pause_.push_back(device.status);
}

void TouchClock::start() {
  try {
    thread_ = std::thread([this] { run(); });
    if (soft_) soft_->start();
  } catch (...) {  // one thread started, the other did not
    stop();
    throw;
  }
}

void TouchClock::pause(bool paused) {
  paused_ = paused;
  if (soft_) soft_->pause(paused);
}

// The touch thread is joined first, so that forces are zero however long a solver takes, or hangs.
void TouchClock::stop() {
  if (soft_) soft_->request_stop();
  stop_ = true;
  if (thread_.joinable()) thread_.join();
  if (soft_) soft_->stop();
}

const TouchFigures& TouchClock::figures() {
  figures_.acquire();
  return figures_.read();
}

void TouchClock::tick(Tick tick) {
  if (hooks_.before) hooks_.before(tick);
  schedule_.run(world_, tick);
  if (hooks_.after) hooks_.after(tick);
  noted_ = true;
  now_.store(tick.index, std::memory_order_relaxed);
}

// Runs last_ with every device lost: it passes through safety, so its forces are zero. No device is read.
void TouchClock::tick_without_devices() {
  for (auto [entity, device] : world_.registry.view<HapticDevice>()) device.status = DeviceStatus::kLost;
  schedule_.run(world_, last_);
  if (hooks_.after) hooks_.after(last_);
  noted_ = true;
  now_.store(last_.index, std::memory_order_relaxed);
}

void TouchClock::pause_devices() {
  std::size_t i = 0;
  for (auto [entity, device] : world_.registry.view<HapticDevice>()) before_pause_[i++] = device.status;
  tick_without_devices();
  i = 0;
  bool found = false;  // a mouse that was first sensed in this very tick
  for (auto [entity, device] : world_.registry.view<HapticDevice>()) {
    if (device.status == DeviceStatus::kReady) before_pause_[i] = device.status, found = true;
    ++i;
  }
  if (found) let_go(world_, last_);
}

void TouchClock::resume_devices() {
  std::size_t i = 0;
  for (auto [entity, device] : world_.registry.view<HapticDevice>()) device.status = before_pause_[i++];
}

void TouchClock::publish_figures(double time) {
  if (++count_ % (static_cast<std::uint64_t>(rate_ * kReportEvery) + 1) != 0) return;
  const std::uint64_t ns = now_ns();
  const Histogram& cost = schedule_.total();
  figures_.write() = {time,
                      static_cast<double>(count_ - reported_count_) * 1e9 / static_cast<double>(ns - reported_at_),
                      cost.percentile_us(0.5),
                      cost.percentile_us(0.99),
                      cost.max_us(),
                      overruns_};
  figures_.publish();
  reported_at_ = ns;
  reported_count_ = count_;
}

void TouchClock::loop() {
  RealtimeClock clock(rate_);
  std::uint64_t stood = 0, stood_overruns = 0;        // periods passed, and missed, in pauses
  std::uint64_t pause_index = 0, pause_overruns = 0;  // start of the last pause
  bool standing = false;
  reported_at_ = now_ns();
  while (!stop_ && !(soft_ && soft_->failed())) {
    const Tick wall = clock.next();
    if (paused_) {
      if (!standing) {
        const std::uint64_t index = wall.index - stood;
        if (index >= ticks_) break;
        last_ = {index, wall.dt, static_cast<double>(index) * wall.dt};
        pause_index = wall.index + 1;
        pause_overruns = clock.overruns();
        pause_devices();
      }
      standing = true;
      if (hooks_.idle) hooks_.idle(last_);
      continue;
    }
    if (standing) {
      stood += wall.index - pause_index;
      stood_overruns += clock.overruns() - pause_overruns;
      resume_devices();
      standing = false;
    }
    const std::uint64_t index = wall.index - stood;
    if (index >= ticks_) break;
    overruns_ = clock.overruns() - stood_overruns;
    const std::uint64_t next = count_ > 0 ? last_.index + 1 : index;
    last_ = {index, wall.dt, static_cast<double>(index) * wall.dt,
             index > next ? static_cast<double>(index - next) * wall.dt : 0.0};
    tick(last_);
    publish_figures(last_.time);
  }
  if (standing) stood_overruns += clock.overruns() - pause_overruns;
  overruns_ = clock.overruns() - stood_overruns;
}

// The last row, if there is any, has zero force after every failure.
void TouchClock::end_after_error() {
  let_go(world_, last_);
  if (!noted_) return;
  ++last_.index;
  last_.time = static_cast<double>(last_.index) * last_.dt;
  try {
    if (hooks_.after) hooks_.after(last_);
    now_.store(last_.index, std::memory_order_relaxed);
  } catch (...) {  // the first error is reported
  }
}

void TouchClock::run() {
  granted_ = request_realtime_priority();
  try {
    loop();
    ++last_.index;
    last_.time = static_cast<double>(last_.index) * last_.dt;
    tick_without_devices();
  } catch (const std::exception& thrown) {
    error_ = Error{"touch clock", std::string("stopped by an exception: ") + thrown.what() + kReport};
  } catch (...) {
    error_ = Error{"touch clock", std::string("stopped by an exception of an unknown kind") + kReport};
  }
  if (error_) end_after_error();
  if (hooks_.end) hooks_.end();
  done_ = true;
}

}  // namespace pliant
