// A recording in progress: the pose of every probe and tool in every tick. The touch clock adds poses; the owner, or in
// real time a thread of the recorder, passes them to a file or to memory.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
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

// Pose of one probe or tool in one tick.
struct PoseRow {
  std::uint64_t tick = 0;
  std::uint32_t effector = 0;
  RecordedPose pose;
};

class PoseRecorder {
 public:
  PoseRecorder(std::unique_ptr<RecordingSink> sink, std::size_t effectors);
  // Touch clock: every effector of a tick, in order. `ready`: its state was known and fresh. `felt`: its guard passed
  // the force.
  void note(std::uint64_t tick, std::uint32_t effector, const HapticDevice& device, bool ready, bool felt);
  // Touch clock: the same for every hand of a world, after a tick.
  void note(World& world, const std::vector<Entity>& hands, Tick tick);
  // Owner: registers an event sent to the touch clock and returns its number. Touch clock: stamp() sets the tick in
  // which it takes effect.
  std::uint32_t announce(const RecordedEvent& event);
  void stamp(std::uint32_t number, std::uint64_t tick) { stamps_.record({number, tick}); }
  void write_now(const RecordedEvent& event) { sink_->event(event); }  // before the first tick
  void drain();
  std::size_t room() const { return room_; }  // [ticks] capacity
  void start();                               // starts a thread that drains
  Status finish();
  // Owner's thread, while no thread drains: the reason why writing failed; number of ticks written.
  const std::optional<Error>& failure() const { return sink_->failure(); }
  std::uint64_t ticks() const { return sink_->ticks(); }

 private:
  std::unique_ptr<RecordingSink> sink_;
  std::size_t room_;                   // [ticks] capacity
  std::vector<RecordedPose> last_;     // touch clock: last valid pose per effector
  std::vector<RecordedPose> pending_;  // of the current tick
  std::uint64_t pending_tick_ = 0;
  Recorder<PoseRow> rows_;
  std::vector<PoseRow> taken_;
  struct Stamp {
    std::uint32_t number = 0;
    std::uint64_t tick = 0;
  };
  void write_events(std::uint64_t until);
  Recorder<Stamp> stamps_;
  std::mutex events_mutex_;              // between the owner and the writing thread
  std::deque<RecordedEvent> announced_;  // by number, from first_announced_ on
  std::uint32_t first_announced_ = 1, next_announced_ = 1;
  std::vector<Stamp> stamped_;  // in order, not yet written
  std::jthread thread_;
};

}  // namespace pliant
