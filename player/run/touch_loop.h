// The loop around the touch schedule: in lockstep with virtual time on this thread, or in real time on its own.
#pragma once

#include <cstdint>
#include <vector>

#include "components/world.h"
#include "engine/run/device_links.h"
#include "engine/run/journal.h"
#include "engine/run/recording.h"
#include "engine/run/soft_clock.h"
#include "player/interrupt.h"
#include "player/record/keeper.h"
#include "player/record/output_folder.h"
#include "player/run/frames.h"
#include "runtime/schedule.h"

namespace pliant {

inline constexpr const char* kNoPriority =
    "the system does not grant SCHED_FIFO, so ticks may come late; see `ulimit -r`";

struct TouchLoop {
  World& world;
  Schedule<World>& schedule;
  Journal& journal;
  Keeper& keeper;
  OutputFolder& out;
  const Interrupt& interrupt;              // ends a run early, cleanly
  double rate = 1000.0;                    // [Hz]
  std::uint64_t ticks = 0;                 // how many to run
  Frames* frames = nullptr;                // none: no pictures
  std::vector<std::uint64_t> frame_ticks;  // after which ticks a picture is taken, ascending
  const Recording* replay = nullptr;       // poses for every tick, lockstep only
  SoftClock* soft = nullptr;               // none: nothing soft
  DeviceLinks* devices = nullptr;          // none: no device
};

Status run_lockstep(TouchLoop& loop);
// `overruns`: ticks that could not begin in time and were skipped.
Status run_realtime(TouchLoop& loop, std::uint64_t& overruns);

}  // namespace pliant
