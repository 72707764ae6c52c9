// A recording that is being written: the pose of every probe and tool at every tick. The touch clock notes; the owner,
// or a thread of the recorder's in real time, writes.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "components/world.h"
#include "engine/run/recording.h"
#include "runtime/recorder.h"
#include "runtime/result.h"
#include "runtime/schedule.h"

namespace pliant {

// One probe's or tool's pose of one tick, on its way into a recording.
struct PoseRow {
  std::uint64_t tick = 0;
  std::uint32_t effector = 0;
  RecordedPose pose;
};

class PoseRecorder {
 public:
  PoseRecorder(RecordingWriter writer, std::size_t effectors);
  // Touch clock: every effector of a tick, in order. `ready`: its state was known and fresh.
  // `felt`: its guard let the force leave.
  void note(std::uint64_t tick, std::uint32_t effector, const HapticDevice& device, bool ready, bool felt);
  // Touch clock: the same of every hand of a world, after a tick.
  void note(World& world, const std::vector<Entity>& hands, Tick tick);
  // Owner: an event on its way to the touch clock; its number. Touch clock: the tick that it takes effect in.
  std::uint32_t announce(const RecordedEvent& event);
  void stamp(std::uint32_t number, std::uint64_t tick) { stamps_.record({number, tick}); }
  void write_now(const RecordedEvent& event) { writer_.event(event); }  // before the first tick
  void drain();
  std::size_t room() const { return room_; }  // [ticks] that may wait
  void start();                               // a thread drains from now on
  Status finish();
  // Owner's, where no thread drains: why nothing more can be written; ticks that were.
  const std::optional<Error>& failure() const { return writer_.failure(); }
  std::uint64_t ticks() const { return writer_.ticks(); }

 private:
  RecordingWriter writer_;
  std::size_t room_;                   // [ticks] that may wait
  std::vector<RecordedPose> last_;     // touch clock's: the last that was a pose, of each
  std::vector<RecordedPose> pending_;  // of the tick under way
  std::uint64_t pending_tick_ = 0;
  Recorder<PoseRow> rows_;
  std::vector<PoseRow> taken_;
  struct Stamp {
    std::uint32_t number = 0;
    std::uint64_t tick = 0;
  };
  void write_events(std::uint64_t until);
  Recorder<Stamp> stamps_;
  std::mutex events_mutex_;              // between the owner and the thread that writes
  std::deque<RecordedEvent> announced_;  // by number, from first_announced_ on
  std::uint32_t first_announced_ = 1, next_announced_ = 1;
  std::vector<Stamp> stamped_;  // in order, not yet written
  std::jthread thread_;
};

}  // namespace pliant
