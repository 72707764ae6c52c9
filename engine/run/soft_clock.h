// The soft clock: runs the soft schedule beside the touch clock.
// - Lockstep: on the caller's thread, whenever virtual time reaches a multiple of Simulation::soft_step, before the
// touch tick of that time, which uses what it publishes.
// - Real time: on a separate thread, at most one step per soft_step. A late step is an overrun. Its length is the time
// since the previous one (up to kLongestStep steps), so that tissue keeps pace with the hand.
// It shares only TripleBuffer and Ring with other clocks.
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
  std::uint32_t contacts = 0, contacts_max = 0;  // in the last step; largest in any
  std::uint64_t sweeps_sum = 0;
  double residual_max = 0.0;  // [m/s] largest residual of the contact solve
  double time_lost = 0.0;     // [s] in real time: delay of the bodies because steps would have been too long
};

// A real-time step that begins `late` [s] after its due time.
struct LateStep {
  double length = 0.0;  // [s] of the step
  double lost = 0.0;    // [s] by which bodies are delayed
};

class SoftClock {
 public:
  static constexpr double kLongestStep = 3.0;  // [1] of soft_step
  static LateStep late_step(double late, double soft_step);

  // A prepared world; without soft parts there are no steps.
  explicit SoftClock(World& world);
  ~SoftClock() { stop(); }

  // Before the first step: notes every step in this journal, which must outlive the clock.
  void note_in(BodyJournal& journal) { journal_ = &journal; }

  // Lockstep. Runs every step up to `time` [s].
  void reach(double time);

  // Real time.
  void start();
  void pause(bool paused) { paused_ = paused; }
  void stop();                           // waits for the current step
  void request_stop() { stop_ = true; }  // does not wait
  const SoftFigures& latest();           // from one thread only
  // True if a step threw; no more steps follow. Thread-safe.
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
  double time_ = 0.0;  // [s] start of the next step
  TripleBuffer<SoftFigures> reported_;
  std::atomic<bool> stop_{false}, paused_{false}, failed_{false};
  std::optional<Error> error_;
  std::thread thread_;
};

}  // namespace pliant
