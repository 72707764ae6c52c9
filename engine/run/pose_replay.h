// A recording that moves every probe and tool: its ticks replace the clock's, its poses those of the devices.
#pragma once

#include <cstddef>
#include <vector>

#include "components/world.h"
#include "engine/run/recording.h"
#include "runtime/schedule.h"

namespace pliant {

class PoseReplay {
 public:
  // A prepared world with the hands (hands(world)) of the recording, in that order. Both must outlive it. The devices'
  // previous sources no longer move them.
  PoseReplay(World& world, const Recording& recording);

  std::size_t size() const { return recording_->ticks.size(); }  // [ticks]
  // Starts tick `n` of the recording, below size(), including the ticks that its run missed before it, and sets its
  // device poses.
  Tick begin_tick(std::size_t n);
  // After the tick: forces that a guard withheld in the recorded run become zero.
  void end_tick();

 private:
  World* world_;
  const Recording* recording_;
  std::vector<Entity> hands_, devices_;  // kNoEntity: a hand without a device
};

}  // namespace pliant
