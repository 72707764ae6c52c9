// A recording that moves every probe and tool: its ticks take the place of the clock's, its poses that of the devices.
#pragma once

#include <cstddef>
#include <vector>

#include "components/world.h"
#include "engine/run/recording.h"
#include "runtime/schedule.h"

namespace pliant {

class Replay {
 public:
  // A prepared world with the hands (hands(world)) of the recording, in that order. Both outlive it. Whatever moved
  // their devices before moves them no more.
  Replay(World& world, const Recording& recording);

  std::size_t size() const { return recording_->ticks.size(); }  // [ticks]
  // Tick `n` of the recording, below size(), with the ticks that its run missed before it; its poses are the devices'
  // then.
  Tick begin_tick(std::size_t n);
  // After the tick: forces that a guard withheld in the recorded run are zero.
  void end_tick();

 private:
  World* world_;
  const Recording* recording_;
  std::vector<Entity> hands_, devices_;  // kNoEntity: a hand without a device
};

}  // namespace pliant
