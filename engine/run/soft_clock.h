// The soft clock: runs the soft schedule beside the touch clock.
// - Lockstep: on the caller's thread, whenever virtual time has reached a multiple of Simulation::soft_step, before the
//   touch tick of that moment; what it publishes, that tick has.
// - Real time: on a thread of its own, as fast as it can but no faster than one step every soft_step; a step that comes
//   late is an overrun, and as long as the time since the one before (up to kLongestStep steps), so that tissue keeps
//   pace with the hand. It shares nothing with other clocks but what travels by TripleBuffer and Ring.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>

#include "components/world.h"
#include "engine/run/body_journal.h"
#include "runtime/exchange.h"
#include "runtime/result.h"
#include "runtime/schedule.h"

namespace pliant {

struct SoftFigures {
  std::uint64_t steps = 0, overruns = 0;
  double step_ms = 0.0;                          // [ms] of the last one
  std::uint64_t contacts_sum = 0;                // over all steps
  std::uint32_t contacts = 0, contacts_max = 0;  // of the last step; of any
  std::uint64_t sweeps_sum = 0;
  double residual_max = 0.0;  // [m/s] largest that the contact solve left
  double time_lost = 0.0;     // [s] in real time: by which bodies fell behind, where steps would have been too long
};

// A step in real time that begins `late` [s] after it was due.
struct LateStep {
  double length = 0.0;  // [s] of the step
  double lost = 0.0;    // [s] by which bodies fall behind
};

class SoftClock {
 public:
  static constexpr double kLongestStep = 3.0;  // [1] of soft_step
  static LateStep late_step(double late, double soft_step);

  // A prepared world; one without anything soft has no steps.
  explicit SoftClock(World& world);
  ~SoftClock() { stop(); }

  // Before the first step: every step is noted here from now on. Outlives the clock.
  void note_in(BodyJournal& journal) { journal_ = &journal; }

  // Lockstep. Every step up to `time` [s].
  void reach(double time);

  // Real time.
  void start();
  void pause(bool paused) { paused_ = paused; }
  void stop();                           // waits for the step under way
  void tell_to_stop() { stop_ = true; }  // does not
  const SoftFigures& latest();           // from one thread only
  // A step threw, and there will be no more of them. From any thread.
  bool failed() const { return failed_; }

  // Valid while no thread runs.
  bool any() const { return world_.soft != nullptr; }
  const SoftFigures& figures() const { return figures_; }
  const std::optional<Error>& error() const { return error_; }
  const Schedule<World>& schedule() const { return schedule_; }
  std::uint64_t tetrahedra() const { return tetrahedra_; }

 private:
  void step(double dt);
  void run();
  void loop();

  World& world_;
  Schedule<World> schedule_;
  SoftFigures figures_;
  BodyJournal* journal_ = nullptr;
  std::uint64_t tetrahedra_ = 0;
  double time_ = 0.0;  // [s] where the next step begins
  TripleBuffer<SoftFigures> told_;
  std::atomic<bool> stop_{false}, paused_{false}, failed_{false};
  std::optional<Error> error_;
  std::thread thread_;
};

}  // namespace pliant
