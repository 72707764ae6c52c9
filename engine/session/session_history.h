// All inputs of a lockstep session since its time 0: the pose of every probe and tool in every tick, and the program's
// actions between ticks. Session::save_state saves these. Running them again in the same scene reproduces the session
// to the bit, with tissue, contacts and guards. Owner's thread.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/run/recording.h"

namespace pliant {

// A device in one tick.
struct HistoryPose {
  dvec3 position{0};  // [m] world
  dquat rotation{1, 0, 0, 0};
  double sensed_at = 0.0;  // [s]
  bool ready = false;      // and not stale
  bool felt = true;        // false: its guard withheld the force
  bool grips = false;      // its device senses a grip
  double grip = 0.0;       // [1] 0 to 1
};

struct SessionHistory {
  const char* lacking = nullptr;             // reason why no state can be saved; null: it can
  std::map<std::string, std::string> begun;  // initial settings: NODE.EXT.KEY -> value
  std::vector<RecordedEvent> events;         // by tick
  std::vector<HistoryPose> poses;            // [tick][effector]
};

// The source of one effector, as far as it continues by itself.
struct SavedSource {
  std::uint8_t kind = 0;               // EffectorSource
  std::uint64_t path = 0;              // hash of its path
  bool placed = false, waits = false;  // of a pose that was set: it is active; it is still pending
  double heard_at = 0.0, lasts = 1e-3;
  HistoryPose from, now, to;  // position and rotation
};

struct SavedState {
  double rate = 1000.0;  // [Hz]
  std::uint64_t scene = 0;
  std::vector<std::string> effectors;
  std::uint64_t ticks = 0;
  std::vector<SavedSource> sources;
  SessionHistory history;
};

std::vector<std::uint8_t> pack_state(const SavedState& state);
// Untrusted bytes.
Result<SavedState> unpack_state(const std::vector<std::uint8_t>& bytes);

}  // namespace pliant
