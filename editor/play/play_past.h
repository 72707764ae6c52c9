// The past of a run: a recording from which it can be repeated, and samples for plots.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "components/probe.h"
#include "engine/run/recording.h"

namespace pliant {

// The mouse's drag of a body from this tick on.
struct PlayHold {
  std::uint64_t tick = 0;
  std::uint32_t effector = 0;
  ProbeHold hold;
};

// From the first tick on. The same level with the same past gives the same bits.
struct PlayPast : Recording {
  static constexpr std::size_t kMostTicks = 1'000'000;  // in longer runs, going back is not possible
  std::vector<PlayHold> holds;                          // by tick, ascending
};

// Where a run stores its past when it ends.
struct PlayKept {
  std::mutex mutex;
  std::shared_ptr<const PlayPast> past;  // null: still running
};

// The sample of one probe or tool in one tick.
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
