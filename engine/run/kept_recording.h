// A recording in memory, for repeating a run that has just been made. It may be copied while a recorder fills it.
#pragma once

#include <mutex>

#include "engine/run/recording.h"

namespace pliant {

class KeptRecording final : public RecordingSink {
 public:
  // Of the first `most` ticks.
  KeptRecording(std::size_t effectors, std::size_t most) : effectors_(effectors), most_(most) {}
  void tick(std::uint64_t index) override;
  void pose(const RecordedPose& pose) override;
  void event(const RecordedEvent& event) override;
  const std::optional<Error>& failure() const override { return none_; }
  std::uint64_t ticks() const override;
  Status finish() override { return Done{}; }
  Recording copy() const;  // of all complete ticks; from any thread

 private:
  const std::size_t effectors_, most_;
  const std::optional<Error> none_;
  mutable std::mutex mutex_;
  bool full_ = false;
  Recording kept_;
};

}  // namespace pliant
