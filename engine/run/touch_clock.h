// The touch clock in real time: one loop, on a thread of its own, for every program that feels. What it tells leaves by
// exchanges that never wait.
//
// However it ends - it is told to, its ticks are over, or something in it fails - its last tick has every device lost:
// it goes through safety, so that the last force sent is zero.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <thread>

#include "components/world.h"
#include "engine/run/soft_clock.h"
#include "runtime/exchange.h"
#include "runtime/result.h"
#include "runtime/schedule.h"

namespace pliant {

struct TouchFigures {
  double time = 0.0;                       // [s] of the world
  double rate = 0.0;                       // [Hz] ticks over the last tenth of a second
  double p50 = 0.0, p99 = 0.0, max = 0.0;  // [us] of a tick, since the start
  std::uint64_t overruns = 0;
};

// What else a tick does, on the touch clock. None may allocate or wait.
struct TouchHooks {
  std::function<void(Tick)> before;  // drivers are read, edits come in
  std::function<void(Tick)> after;   // drivers are written, rows are noted
  std::function<void(Tick)> idle;    // instead of both, while it is paused: the forces are zero
  std::function<void()> end;         // last of all, whatever ended it: drivers are written zero. Must not throw
};

// All devices are lost and feel nothing: safety has been told, so that each passes the gate again when it comes back.
void let_go(World& world, Tick tick);

class TouchClock {
 public:
  // Runs at most `ticks`. `soft` starts, pauses and stops with it; null: none. All outlive it.
  TouchClock(World& world, Schedule<World>& schedule, SoftClock* soft, double rate, std::uint64_t ticks,
             TouchHooks hooks);
  ~TouchClock() { stop(); }

  // The world is the thread's from start() until stop() returns.
  void start();
  // Stands still in its own time. Devices are let go in one tick, which is noted like any other; those that were ready
  // come back through the gate.
  void pause(bool paused);
  bool paused() const { return paused_; }
  void stop();
  bool done() const { return done_; }

  std::uint64_t now() const { return now_; }  // the tick it has reached
  const TouchFigures& figures();              // the newest; from one thread only
  // Valid after stop().
  std::uint64_t overruns() const { return overruns_; }
  bool has_priority() const { return granted_; }
  const std::optional<Error>& error() const { return error_; }  // why it ended before it was told to

 private:
  void run();
  void loop();
  void tick(Tick tick);
  void tick_without_devices();
  void pause_devices();
  void end_after_error();
  void resume_devices();
  void tell(double time);

  World& world_;
  Schedule<World>& schedule_;
  SoftClock* soft_;
  double rate_;
  std::uint64_t ticks_;
  TouchHooks hooks_;
  TripleBuffer<TouchFigures> figures_;
  std::atomic<bool> stop_{false}, paused_{false}, done_{false};
  std::atomic<std::uint64_t> now_{0};
  std::vector<DeviceStatus> before_pause_;
  Tick last_{};
  std::uint64_t told_at_ = 0, told_count_ = 0, count_ = 0;
  std::uint64_t overruns_ = 0;
  bool noted_ = false;  // a tick has come to its end
  bool granted_ = false;
  std::optional<Error> error_;
  std::thread thread_;
};

}  // namespace pliant
