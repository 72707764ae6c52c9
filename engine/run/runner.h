// A prepared world that runs: ticks of the touch schedule and steps of the soft clock, in lockstep on the caller's
// thread or in real time on threads of their own. A session, the command, its window, the editor's play, studies and
// error budgets all tick by it. What else takes part in a tick (devices, a replay, a recorder, a journal) is attached.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "components/world.h"
#include "engine/run/soft_clock.h"
#include "engine/run/touch_clock.h"
#include "runtime/result.h"
#include "runtime/schedule.h"

namespace pliant {

// Takes part in every tick; functions that are empty are left out.
struct TickPart : TouchHooks {
  std::function<Status()> start;  // owner's thread, before the clocks of real time start; an error keeps them from it
  std::function<void()> halt;     // owner's thread, when they have stopped, or where a later one's start failed
};

class Runner {
 public:
  // `world` outlives it.
  explicit Runner(World& world);
  Runner(const Runner&) = delete;
  ~Runner() { stop(); }

  // Before the first tick. `before` and `after` run in the order in which they were attached.
  void attach(TickPart part) { parts_.push_back(std::move(part)); }

  // --- Lockstep. The soft clock's steps up to the tick's time, then the tick. Exceptions of systems leave it.
  void step(Tick tick);

  // --- Real time: at most `ticks`. The world is the clocks' until stop() returns. Tools have a budget from then on.
  Status start(std::uint64_t ticks);
  void pause(bool paused) { clock_->pause(paused); }
  void stop();                                        // idempotent; forces are zero whatever ended it
  TouchClock* clock() const { return clock_.get(); }  // null before start() and after stop()
  // Valid after stop().
  std::uint64_t overruns() const { return overruns_; }
  std::uint64_t reached() const { return reached_; }  // the last tick
  bool has_priority() const { return priority_; }
  const std::optional<Error>& error() const { return error_; }  // why a clock ended before it was stopped

  World& world() { return world_; }
  const Schedule<World>& schedule() const { return schedule_; }
  SoftClock& soft() { return soft_; }
  const SoftClock& soft() const { return soft_; }

 private:
  TouchHooks hooks();
  void halt() noexcept;

  World& world_;
  Schedule<World> schedule_;
  SoftClock soft_;
  std::vector<TickPart> parts_;
  std::size_t started_ = 0;  // of parts_
  std::unique_ptr<TouchClock> clock_;
  std::uint64_t overruns_ = 0, reached_ = 0;
  bool priority_ = true;
  std::optional<Error> error_;
};

}  // namespace pliant
