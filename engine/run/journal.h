// Journal of the ticks. This is the touch clock's half: it reads the world after each tick and neither allocates nor
// waits. A ring passes the rows to the keeper (keeper.h).
#pragma once

#include <cstdint>
#include <vector>

#include "components/touch_event.h"
#include "components/world.h"
#include "engine/run/body_journal.h"
#include "engine/run/limits.h"
#include "runtime/hash.h"
#include "runtime/recorder.h"
#include "systems/device/reading.h"

namespace pliant {

struct ToolTouchState;

// One probe or tool after one tick.
struct TickRow {
  std::uint64_t tick = 0;
  double time = 0.0;        // [s]
  std::uint32_t probe = 0;  // index into Journal::probes()
  ProbeReading reading;
  dvec3 device_position{0};  // [m] world, as sensed
  dquat device_rotation{1, 0, 0, 0};
  dvec3 torque{0};            // [N m] world, on the hand
  std::uint32_t objects = 0;  // touched; for a tool in the last soft step, itself excluded
  std::uint8_t limited = 0;   // 1 << SafetyLimit: limits that changed the force (systems/safety/safety.h)
  bool late = false;          // of a tool: its contacts were not solved within the tick's budget
  bool stale = false;         // of a tool: its model is older than kStaleSteps soft steps
};

struct AwakeStats {
  Entity object;
  std::uint64_t sum = 0;  // of awake vertices over all ticks
  std::uint32_t max = 0;
};

// [rows] Capacity: `seconds` of rows, limited by limits::kJournal. At least two ticks of every hand, since in lockstep
// rows leave after each tick.
std::size_t rows_that_wait(double seconds, double rate, std::size_t hands);

class Journal {
 public:
  // Covers every probe, tool and deformable of a prepared world. Has room for `seconds` of rows, limited by
  // limits::kJournal, until drained. `bodies`: what tools touch; null: none.
  Journal(const World& world, double seconds, const BodyJournal* bodies = nullptr);

  void note(const World& world, Tick tick);
  void drain(std::vector<TickRow>& rows) { recorder_.drain(rows); }
  void drain(std::vector<TouchEvent>& events) { events_.drain(events); }

  const std::vector<Entity>& probes() const { return probes_; }  // hands(): tools after the probes
  // Valid when the touch clock has stopped.
  const std::vector<AwakeStats>& awake() const { return awake_; }
  // Everything this probe or tool has pressed on since the start.
  std::vector<Entity> touched(Entity hand) const;
  std::vector<PressedPair> pressed_pairs() const {
    return bodies_ ? bodies_->pressed_pairs() : std::vector<PressedPair>();
  }
  std::uint64_t ticks() const { return ticks_; }
  std::uint64_t lost() const { return recorder_.lost(); }
  std::uint64_t events_lost() const { return events_.lost(); }
  Hash hash() const { return hash_; }  // of every force so far

 private:
  // Per probe or tool, created before the first tick.
  struct Hand {
    const ToolTouchState* tool = nullptr;  // null: a probe
    std::uint64_t late = 0;                // ticks_late after the last tick
    std::vector<std::uint8_t> now, ever;   // of a probe, per awake_: pressed on now; since the start
  };
  void note_tool(Hand& hand, Tick tick, TickRow& row);
  void note_probe(const World& world, Entity probe, Hand& hand, TickRow& row);

  const BodyJournal* bodies_;
  std::vector<Hand> hands_;
  std::vector<Entity> probes_;
  std::vector<HandSafety> safety_;  // per hand
  std::vector<AwakeStats> awake_;
  Recorder<TickRow> recorder_;
  Recorder<TouchEvent> events_{kMostEventsWaiting};
  Hash hash_;
  std::uint64_t ticks_ = 0;
};

}  // namespace pliant
