// What is noted of every tick. The touch clock's half: it reads the world after each tick, and neither allocates nor
// waits. Rows leave through a ring for whoever keeps them (keeper.h).
#pragma once

#include <cstdint>
#include <vector>

#include "components/world.h"
#include "player/limits.h"
#include "runtime/hash.h"
#include "runtime/recorder.h"
#include "systems/touch/reading.h"

namespace pliant {

// One probe or tool after one tick.
struct TickRow {
  std::uint64_t tick = 0;
  double time = 0.0;        // [s]
  std::uint32_t probe = 0;  // index into Journal::probes()
  ProbeReading reading;
  dvec3 device_position{0};  // [m] world, as sensed: what a recording keeps
  dquat device_rotation{1, 0, 0, 0};
  dvec3 torque{0};  // [N m] world, on the hand
  bool device_ready = false;
  std::uint8_t limited = 0;  // 1 << SafetyLimit: what kept the hand from what the law says (systems/device/safety.h)
};

struct AwakeStats {
  Entity object;
  std::uint64_t sum = 0;  // of awake vertices over all ticks
  std::uint32_t max = 0;
};

class Journal {
 public:
  // Every probe, tool and deformable of a prepared world. Holds `seconds` of rows until they are drained.
  Journal(const World& world, double seconds);

  void note(const World& world, Tick tick);
  void drain(std::vector<TickRow>& rows) { recorder_.drain(rows); }

  const std::vector<Entity>& probes() const { return probes_; }  // hands(): tools after the probes
  // Valid when the touch clock has stopped.
  const std::vector<AwakeStats>& awake() const { return awake_; }
  std::uint64_t ticks() const { return ticks_; }
  std::uint64_t lost() const { return recorder_.lost(); }
  Hash hash() const { return hash_; }  // of every force so far

 private:
  std::vector<Entity> probes_;
  std::vector<HandSafety> safety_;  // of each
  std::vector<AwakeStats> awake_;
  Recorder<TickRow> recorder_;
  Hash hash_;
  std::uint64_t ticks_ = 0;
};

}  // namespace pliant
