#include "engine/run/kept_recording.h"

namespace pliant {

void KeptRecording::tick(std::uint64_t index) {
  const std::lock_guard lock(mutex_);
  full_ = kept_.ticks.size() >= most_;
  if (!full_) kept_.ticks.push_back(index);
}

void KeptRecording::pose(const RecordedPose& pose) {
  const std::lock_guard lock(mutex_);
  if (!full_) kept_.poses.push_back(pose);
}

void KeptRecording::event(const RecordedEvent& event) {
  const std::lock_guard lock(mutex_);
  if (!full_) kept_.events.push_back(event);
}

std::uint64_t KeptRecording::ticks() const {
  const std::lock_guard lock(mutex_);
  return kept_.ticks.size();
}

Recording KeptRecording::copy() const {
  const std::lock_guard lock(mutex_);
  Recording copy = kept_;
  if (effectors_ > 0) copy.ticks.resize(copy.poses.size() / effectors_);
  copy.poses.resize(copy.ticks.size() * effectors_);
  return copy;
}

}  // namespace pliant
