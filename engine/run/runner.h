// Runs a prepared world: ticks of the touch schedule and steps of the soft clock, in lockstep on the caller's thread or
// in real time on separate threads. Used by sessions, the command, its window, the editor's play, studies and error
// budgets. Other participants of a tick (devices, a replay, a recorder, a journal) are attached.
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

// A participant in every tick; empty functions are skipped.
struct TickPart : TouchHooks {
  std::function<Status()> start;  // owner's thread, before the real-time clocks start; an error prevents the start
  std::function<void()> halt;     // owner's thread, after the clocks stopped, or if a later part's start failed
};

class Runner {
 public:
  // `world` must outlive the runner.
  explicit Runner(World& world);
  Runner(const Runner&) = delete;
  ~Runner() { stop(); }

  // Before the first tick. `before` and `after` run in the order of attachment.
  void attach(TickPart part) { parts_.push_back(std::move(part)); }

  // --- Lockstep. Runs the soft clock's steps up to the tick's time, then the tick. Exceptions of systems propagate.
  void step(Tick tick);

  // --- Real time: at most `ticks`. The clocks own the world until stop() returns. From then on tools have a time
  // budget.
  Status start(std::uint64_t ticks);
  void pause(bool paused) { clock_->pause(paused); }
  void stop();                                        // idempotent; forces are zero in every case
  TouchClock* clock() const { return clock_.get(); }  // null before start() and after stop()
  // Valid after stop().
  std::uint64_t overruns() const { return overruns_; }
  std::uint64_t reached() const { return reached_; }  // the last tick
  bool has_priority() const { return priority_; }
  const std::optional<Error>& error() const { return error_; }  // the reason if a clock ended by itself

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
  std::size_t started_ = 0;  // number of parts_
  std::unique_ptr<TouchClock> clock_;
  std::uint64_t overruns_ = 0, reached_ = 0;
  bool priority_ = true;
  std::optional<Error> error_;
};

}  // namespace pliant
