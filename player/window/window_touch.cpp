#include "player/window/window_touch.h"

#include "runtime/clock.h"

namespace pliant {
namespace {

constexpr double kTellEvery = 0.1;  // [s] of figures for a person to read

void set_devices(World& world, DeviceStatus status) {
  for (auto [entity, device] : world.registry.view<HapticDevice>()) {
    device.status = status;
    if (status == DeviceStatus::kLost) device.force_sent = device.torque_sent = dvec3(0);
  }
}

}  // namespace

TouchThread::TouchThread(World& world, Schedule<World>& schedule, Journal& journal, SoftClock* soft, double rate,
                         std::uint64_t ticks)
    : world_(world), schedule_(schedule), journal_(journal), soft_(soft), thread_([this, rate, ticks] {
        run(rate, ticks);
      }) {
  if (soft_) soft_->start();
}

void TouchThread::pause(bool paused) {
  paused_ = paused;
  if (soft_) soft_->pause(paused);
}

void TouchThread::stop() {
  if (soft_) soft_->stop();
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

const TouchFigures& TouchThread::figures() {
  figures_.acquire();
  return figures_.read();
}

void TouchThread::tick(Tick tick) {
  schedule_.run(world_, tick);
  journal_.note(world_, tick);
  now_.store(tick.index, std::memory_order_relaxed);
}

void TouchThread::run(double rate, std::uint64_t ticks) {
  granted_ = request_realtime_priority();
  RealtimeClock clock(rate);
  const auto tell_every = static_cast<std::uint64_t>(rate * kTellEvery) + 1;
  std::uint64_t stood = 0, stood_overruns = 0;                  // periods that passed, and were missed, in pauses
  std::uint64_t pause_index = 0, pause_overruns = 0;            // where the last pause began
  std::uint64_t told_ns = now_ns(), told_count = 0, count = 0;  // for the rate
  bool standing = false;
  Tick last{0, 1 / rate, 0};
  while (!stop_) {
    const Tick wall = clock.next();
    if (paused_) {
      if (!standing) {
        pause_index = wall.index;
        pause_overruns = clock.overruns();
        set_devices(world_, DeviceStatus::kLost);
      }
      standing = true;
      continue;
    }
    if (standing) {
      stood += wall.index - pause_index;
      stood_overruns += clock.overruns() - pause_overruns;
      set_devices(world_, DeviceStatus::kReady);
      standing = false;
    }
    const std::uint64_t index = wall.index - stood;
    if (index >= ticks) break;
    last = {index, wall.dt, static_cast<double>(index) * wall.dt};
    tick(last);
    if (++count % tell_every == 0) {
      const std::uint64_t ns = now_ns();
      const Histogram& cost = schedule_.total();
      figures_.write() = {last.time,
                          static_cast<double>(count - told_count) * 1e9 / static_cast<double>(ns - told_ns),
                          cost.percentile_us(0.5),
                          cost.percentile_us(0.99),
                          cost.max_us(),
                          clock.overruns() - stood_overruns};
      figures_.publish();
      told_ns = ns;
      told_count = count;
    }
  }
  if (standing) stood_overruns += clock.overruns() - pause_overruns;
  overruns_ = clock.overruns() - stood_overruns;
  set_devices(world_, DeviceStatus::kLost);
  ++last.index;
  last.time += last.dt;
  tick(last);
  done_ = true;
}

}  // namespace pliant
