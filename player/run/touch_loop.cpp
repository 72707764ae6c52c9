#include "player/run/touch_loop.h"

#include <chrono>
#include <thread>

#include "lab/console/exit.h"
#include "lab/console/progress.h"
#include "runtime/clock.h"

namespace pliant {

Status run_lockstep(TouchLoop& loop) {
  Progress progress("running");
  LockstepClock clock(loop.runner.world().simulation.touch_rate);
  auto frame = loop.frame_ticks.begin();
  for (std::uint64_t n = 0; n < loop.ticks && !loop.interrupt.requested(); ++n) {
    const Tick tick = loop.replay ? loop.replay->begin_tick(n) : clock.next();
    loop.runner.step(tick);
    loop.keeper.keep(loop.journal);
    for (; loop.frames && frame != loop.frame_ticks.end() && *frame == n; ++frame) {
      loop.frames->update_all(loop.runner.world(), tick);
      if (const Status taken = loop.frames->take(loop.out); !taken) return taken;
    }
    if (n % 64 == 0) progress.update(static_cast<double>(n) / static_cast<double>(loop.ticks));
  }
  return Done{};
}

namespace {

// Beside the clock: keeps rows and takes pictures until the run ends or fails.
Status run_beside(TouchLoop& loop, TouchClock& touch) {
  Progress progress("running");
  Status status = Done{};
  auto frame = loop.frame_ticks.begin();
  while (!touch.done() && status && !loop.interrupt.requested()) {
    loop.keeper.keep(loop.journal);
    const std::uint64_t reached = touch.now();
    if (loop.frames && frame != loop.frame_ticks.end() && *frame <= reached) {
      loop.frames->update(loop.runner.world());
      status = loop.frames->take(loop.out);
      while (frame != loop.frame_ticks.end() && *frame <= reached) ++frame;  // a slow GPU skips pictures
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    progress.update(static_cast<double>(reached) / static_cast<double>(loop.ticks));
  }
  return status;
}

}  // namespace

Status run_realtime(TouchLoop& loop) {
  Status status = Done{};
  try {
    status = loop.runner.start(loop.ticks);
    if (status) status = run_beside(loop, *loop.runner.clock());
  } catch (const std::exception& error) {  // the clock's rows and figures are kept
    status = explain(error);
  }
  loop.runner.stop();
  loop.keeper.keep(loop.journal);
  if (!loop.runner.has_priority()) note(kNoPriority);
  if (loop.runner.error()) return *loop.runner.error();
  return status;
}

}  // namespace pliant
