// What a run has been: poses and edits of every tick, from which it can be had again, and what was felt, to be drawn.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "components/probe.h"
#include "engine/run/recording.h"

namespace pliant {

// A parameter that was set, before the tick of this number ran.
struct PlayEdit {
  std::uint64_t tick = 0;
  std::string object, key;
  double value = 0.0;
};

// What the mouse held of a body from the tick of this number on.
struct PlayHold {
  std::uint64_t tick = 0;
  std::uint32_t effector = 0;
  ProbeHold hold;
};

// From the first tick on. The same level with the same past has the same bits.
struct PlayPast {
  static constexpr std::size_t kMostTicks = 1'000'000;  // longer runs cannot be gone back in
  std::vector<std::uint64_t> ticks;                     // indices, ascending
  std::vector<RecordedPose> poses;                      // [tick][effector]
  std::vector<PlayEdit> edits;                          // by tick, ascending
  std::vector<PlayHold> holds;                          // the same
};

// Where a run leaves its past when it has ended.
struct PlayKept {
  std::mutex mutex;
  std::shared_ptr<const PlayPast> past;  // null: it runs
};

// What one probe or tool felt in one tick.
struct PlaySample {
  static constexpr std::uint16_t kNothing = 0xffff;
  std::uint64_t tick = 0;
  double time = 0.0;                // [s]
  float force = 0, along = 0;       // [N] as sent; its part along the normal
  float depth = 0;                  // [m] below the undeformed surface, 0: outside
  std::uint16_t object = kNothing;  // into PlayStatus::objects
  std::uint8_t limited = 0;         // 1 << SafetyLimit
  bool touching = false;
};

}  // namespace pliant
