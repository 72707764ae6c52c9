#include "player/run/touch_loop.h"

#include <atomic>
#include <chrono>
#include <thread>

#include "player/exit.h"
#include "player/progress.h"
#include "runtime/clock.h"
#include "systems/device/hands.h"

namespace pliant {
namespace {

// A recorded tick: its own time, and the poses that the devices had.
Tick replayed_tick(TouchLoop& loop, std::uint64_t n) {
  const Recording& recording = *loop.replay;
  const double dt = 1.0 / loop.rate;
  const Tick tick{recording.ticks[n], dt, static_cast<double>(recording.ticks[n]) * dt};
  const std::vector<Entity>& probes = loop.journal.probes();
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const RecordedPose& pose = recording.poses[n * probes.size() + i];
    if (!find_device(loop.world, probes[i])) continue;
    HapticDevice* device = &loop.world.registry.get<HapticDevice>(device_of(loop.world, probes[i]));
    device->driver = Driver::kExternal;
    device->path = {};  // nothing but the recording moves it
    device->position = pose.position;
    device->rotation = pose.rotation;
    device->status = pose.ready ? DeviceStatus::kReady : DeviceStatus::kLost;
    device->sensed_at = tick.time;
  }
  return tick;
}

}  // namespace

Status run_lockstep(TouchLoop& loop) {
  Progress progress("running");
  LockstepClock clock(loop.rate);
  auto frame = loop.frame_ticks.begin();
  for (std::uint64_t n = 0; n < loop.ticks && !loop.interrupt.requested(); ++n) {
    const Tick tick = loop.replay ? replayed_tick(loop, n) : clock.next();
    if (loop.soft) loop.soft->reach(tick.time);
    loop.schedule.run(loop.world, tick);
    loop.journal.note(loop.world, tick);
    loop.keeper.keep(loop.journal);
    for (; loop.frames && frame != loop.frame_ticks.end() && *frame == n; ++frame) {
      loop.frames->update_all(loop.world, tick);
      if (const Status taken = loop.frames->take(loop.out); !taken) return taken;
    }
    if (n % 64 == 0) progress.update(static_cast<double>(n) / static_cast<double>(loop.ticks));
  }
  return Done{};
}

Status run_realtime(TouchLoop& loop, std::uint64_t& overruns) {
  Progress progress("running");
  std::atomic<bool> stop{false}, done{false}, granted{false};
  std::atomic<std::uint64_t> now{0};  // the tick that the touch clock has reached
  if (loop.soft) loop.soft->start();
  std::jthread touch([&] {
    granted = request_realtime_priority();
    RealtimeClock clock(loop.rate);
    for (Tick tick = clock.next(); tick.index < loop.ticks && !stop; tick = clock.next()) {
      loop.schedule.run(loop.world, tick);
      loop.journal.note(loop.world, tick);
      now.store(tick.index, std::memory_order_relaxed);
    }
    overruns = clock.overruns();
    done = true;
  });

  Status status = Done{};
  auto frame = loop.frame_ticks.begin();
  while (!done && status) {
    if (loop.interrupt.requested()) stop = true;
    loop.keeper.keep(loop.journal);
    const std::uint64_t reached = now.load(std::memory_order_relaxed);
    if (loop.frames && frame != loop.frame_ticks.end() && *frame <= reached) {
      loop.frames->update(loop.world);
      status = loop.frames->take(loop.out);
      while (frame != loop.frame_ticks.end() && *frame <= reached) ++frame;  // a slow card shows fewer pictures
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    progress.update(static_cast<double>(reached) / static_cast<double>(loop.ticks));
  }
  stop = true;
  touch.join();
  if (loop.soft) loop.soft->stop();
  loop.keeper.keep(loop.journal);
  if (!granted) note("the system does not grant SCHED_FIFO, so ticks may come late; see `ulimit -r`");
  return status;
}

void release_devices(World& world) {
  for (auto [entity, device] : world.registry.view<HapticDevice>()) {
    device.status = DeviceStatus::kLost;
    device.force_sent = device.torque_sent = dvec3(0);
  }
}

}  // namespace pliant
