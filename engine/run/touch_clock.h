// The touch clock in real time: one loop on a separate thread, for every program with haptics. Results leave by
// non-blocking exchanges.
//
// However it ends (on request, after its last tick, or by a failure), every device is lost in its last tick. That tick
// passes through safety, so that the last force sent is zero.
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

// Hooks of a tick, on the touch clock. None may allocate or wait.
struct TouchHooks {
  std::function<void(Tick)> before;  // reads drivers, applies edits
  std::function<void(Tick)> after;   // writes drivers, notes rows
  std::function<void(Tick)> idle;    // called instead of both while paused: the forces are zero
  std::function<void()> end;         // called last in every case: writes zero to drivers. Must not throw
};

// Sets all devices lost, without force. Safety is informed, so that each passes the gate again on return.
void let_go(World& world, Tick tick);

class TouchClock {
 public:
  // Runs at most `ticks`. `soft` starts, pauses and stops with it; null: none. All must outlive it.
  TouchClock(World& world, Schedule<World>& schedule, SoftClock* soft, double rate, std::uint64_t ticks,
             TouchHooks hooks);
  ~TouchClock() { stop(); }

  // The thread owns the world from start() until stop() returns.
  void start();
  // Stops the simulated time. Devices are released in one tick, which is noted like any other; those that were ready
  // return through the gate.
  void pause(bool paused);
  bool paused() const { return paused_; }
  void stop();
  bool done() const { return done_; }

  std::uint64_t now() const { return now_; }  // index of the current tick
  const TouchFigures& figures();              // the newest; from one thread only
  // Valid after stop().
  std::uint64_t overruns() const { return overruns_; }
  bool has_priority() const { return granted_; }
  const std::optional<Error>& error() const { return error_; }  // the reason if it ended by itself

 private:
  void run();
  void loop();
  void tick(Tick tick);
  void tick_without_devices();
  void pause_devices();
  void end_after_error();
  void resume_devices();
  void publish_figures(double time);

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
  std::uint64_t reported_at_ = 0, reported_count_ = 0, count_ = 0;
  std::uint64_t overruns_ = 0;
  bool noted_ = false;  // a tick has been completed
  bool granted_ = false;
  std::optional<Error> error_;
  std::thread thread_;
};

}  // namespace pliant
