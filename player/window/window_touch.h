// The touch clock of a window: in real time, on a thread of its own, until it is told to stop. What it tells leaves by
// exchanges that never wait.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "components/world.h"
#include "engine/journal.h"
#include "engine/soft_clock.h"
#include "runtime/exchange.h"
#include "runtime/schedule.h"

namespace pliant {

struct TouchFigures {
  double time = 0.0;                       // [s] of the world
  double rate = 0.0;                       // [Hz] ticks over the last tenth of a second
  double p50 = 0.0, p99 = 0.0, max = 0.0;  // [us] of a tick, since the start
  std::uint64_t overruns = 0;
};

class TouchThread {
 public:
  // Runs at most `ticks`. The world is the thread's until stop() returns.
  // `soft` starts, pauses and stops with it; null: none.
  TouchThread(World& world, Schedule<World>& schedule, Journal& journal, SoftClock* soft, double rate,
              std::uint64_t ticks);
  ~TouchThread() { stop(); }

  // Stands still in its own time; hands feel nothing meanwhile.
  void pause(bool paused);
  bool paused() const { return paused_; }
  // Ends with one tick in which every device counts as lost: the last thing sent is zero force.
  void stop();
  bool done() const { return done_; }

  std::uint64_t now() const { return now_; }  // the tick it has reached
  const TouchFigures& figures();              // the newest; from one thread only
  // Valid after stop().
  std::uint64_t overruns() const { return overruns_; }
  bool has_priority() const { return granted_; }

 private:
  void run(double rate, std::uint64_t ticks);
  void tick(Tick tick);

  World& world_;
  Schedule<World>& schedule_;
  Journal& journal_;
  SoftClock* soft_;
  TripleBuffer<TouchFigures> figures_;
  std::atomic<bool> stop_{false}, paused_{false}, done_{false};
  std::atomic<std::uint64_t> now_{0};
  std::uint64_t overruns_ = 0;
  bool granted_ = false;
  std::thread thread_;  // last: everything else is there when it starts
};

}  // namespace pliant
