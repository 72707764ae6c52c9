#include "player/run/touch_loop.h"

#include <chrono>
#include <thread>

#include "engine/run/touch_clock.h"
#include "player/exit.h"
#include "player/progress.h"
#include "runtime/clock.h"
#include "systems/device/hands.h"
#include "systems/device/softening.h"

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
    device->driver = DriverKind::kExternal;
    device->path = {};  // nothing but the recording moves it
    device->position = pose.position;
    device->rotation = pose.rotation;
    device->status = pose.ready ? DeviceStatus::kReady : DeviceStatus::kLost;
    if (SafetyState* const safety = safety_of(loop.world, probes[i])) safety->felt = pose.felt;
    device->sensed_at = tick.time;
  }
  return tick;
}

// What a guard did not let leave when it was recorded.
void withhold(TouchLoop& loop) {
  for (const Entity probe : loop.journal.probes()) {
    const SafetyState* const safety = safety_of(loop.world, probe);
    if (!safety || safety->felt) continue;
    HapticDevice& device = loop.world.registry.get<HapticDevice>(device_of(loop.world, probe));
    device.force_sent = device.torque_sent = dvec3(0);
  }
}

}  // namespace

Status run_lockstep(TouchLoop& loop) {
  Progress progress("running");
  LockstepClock clock(loop.rate);
  auto frame = loop.frame_ticks.begin();
  for (std::uint64_t n = 0; n < loop.ticks && !loop.interrupt.requested(); ++n) {
    const Tick tick = loop.replay ? replayed_tick(loop, n) : clock.next();
    if (loop.soft) loop.soft->reach(tick.time);
    if (loop.devices) loop.devices->before(loop.world, tick);
    loop.schedule.run(loop.world, tick);
    if (loop.replay) withhold(loop);
    if (loop.devices) loop.devices->after(loop.world, tick);
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

namespace {

// Beside the clock: rows are kept and pictures taken until it is done, or something is wrong.
Status run_beside(TouchLoop& loop, TouchClock& touch) {
  Progress progress("running");
  Status status = Done{};
  auto frame = loop.frame_ticks.begin();
  while (!touch.done() && status && !loop.interrupt.requested()) {
    loop.keeper.keep(loop.journal);
    const std::uint64_t reached = touch.now();
    if (loop.frames && frame != loop.frame_ticks.end() && *frame <= reached) {
      loop.frames->update(loop.world);
      status = loop.frames->take(loop.out);
      while (frame != loop.frame_ticks.end() && *frame <= reached) ++frame;  // a slow GPU shows fewer pictures
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    progress.update(static_cast<double>(reached) / static_cast<double>(loop.ticks));
  }
  return status;
}

}  // namespace

Status run_realtime(TouchLoop& loop, std::uint64_t& overruns) {
  TouchHooks hooks;
  hooks.after = [&](Tick tick) { loop.journal.note(loop.world, tick); };
  if (loop.devices) loop.devices->hook(loop.world, hooks);
  TouchClock touch(loop.world, loop.schedule, loop.soft, loop.rate, loop.ticks, hooks);
  Status status = Done{};
  try {
    if (loop.devices) status = loop.devices->start();
    if (status) {
      touch.start();
      status = run_beside(loop, touch);
    }
  } catch (const std::exception& error) {  // the clock's rows and figures are kept all the same
    status = explain(error);
  }
  touch.stop();
  if (loop.devices) loop.devices->halt();
  overruns = touch.overruns();
  loop.keeper.keep(loop.journal);
  if (!touch.has_priority()) note(kNoPriority);
  if (touch.error()) return *touch.error();
  if (loop.soft && loop.soft->error()) return *loop.soft->error();
  return status;
}

}  // namespace pliant
