// The loop of a run without a window: ticks in lockstep or real time, rows kept, pictures taken.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/run/journal.h"
#include "engine/run/pose_replay.h"
#include "engine/run/runner.h"
#include "engine/session/live_world.h"
#include "lab/console/interrupt.h"
#include "lab/files/output_folder.h"
#include "player/record/keeper.h"
#include "player/run/frames.h"

namespace pliant {

inline constexpr const char* kNoPriority =
    "the system does not grant SCHED_FIFO, so ticks may come late; see `ulimit -r`";

struct TouchLoop {
  Runner& runner;
  Journal& journal;
  Keeper& keeper;
  OutputFolder& out;
  const Interrupt& interrupt;              // ends a run early, cleanly
  std::uint64_t ticks = 0;                 // number to run
  Frames* frames = nullptr;                // null: no pictures
  std::vector<std::uint64_t> frame_ticks;  // ticks after which a picture is taken, ascending
  PoseReplay* replay = nullptr;            // poses for every tick, lockstep only
  LiveWorld* live = nullptr;               // of a window's sliders
};

Status run_lockstep(TouchLoop& loop);
Status run_realtime(TouchLoop& loop);

}  // namespace pliant
