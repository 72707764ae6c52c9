// What a lockstep session has been given since its time 0: the pose of every probe and tool in every tick, and what the
// program did between ticks. A state is saved as that (Session::save_state): whoever runs it again in the same scene is
// where the session was, to the bit, tissue, contacts and guards included. Owner's.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/run/recording.h"

namespace pliant {

// A device as one tick had it.
struct HistoryPose {
  dvec3 position{0};  // [m] world
  dquat rotation{1, 0, 0, 0};
  double sensed_at = 0.0;  // [s]
  bool ready = false;      // and not stale
  bool felt = true;        // false: its guard let nothing leave
};

struct SessionHistory {
  const char* lacking = nullptr;             // why no state can be saved; null: it is whole
  std::map<std::string, std::string> begun;  // settings that time 0 began with: NODE.EXT.KEY -> value
  std::vector<RecordedEvent> events;         // by tick
  std::vector<HistoryPose> poses;            // [tick][effector]
};

// One effector's source, as far as it goes on by itself.
struct SavedSource {
  std::uint8_t kind = 0;               // EffectorSource
  std::uint64_t path = 0;              // hash of its path
  bool placed = false, waits = false;  // of a pose that was set: it holds; it has not been taken yet
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
