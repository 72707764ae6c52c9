// report.json, and the summary printed at the end of a run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "components/world.h"
#include "engine/run/device_view.h"
#include "engine/run/journal.h"
#include "engine/run/soft_clock.h"
#include "lab/files/output_folder.h"
#include "player/record/keeper.h"
#include "player/run/frames.h"
#include "runtime/schedule.h"

namespace pliant {

struct RunFigures {
  const World& world;
  const Schedule<World>& schedule;
  const Journal& journal;
  const Keeper& keeper;
  const FrameFigures* frames = nullptr;  // of drawing; null: nothing was drawn
  std::size_t pictures = 0;              // number written
  std::string mode;                      // lockstep, realtime
  std::string field;                     // cpu
  double rate = 1000.0;                  // [Hz]
  std::uint64_t overruns = 0;
  std::vector<Note> notes;
  std::string hash;                         // hex
  const SoftClock* soft = nullptr;          // null: nothing soft or rigid moves in the level
  std::vector<std::optional<Miss>> misses;  // per probe of the journal: empty if it had contact or there is no surface
  std::string ended;                        // done, interrupted, or the error that ended it
  bool replayed = false;                    // its poses come from a recording
  DevicesView devices{};                    // that moved probes and tools
};

std::string report_json(const RunFigures& figures);
// Writes report.json and forces.png and moves all staged files into place, as many as possible. Returns the first
// error.
std::optional<Error> write_reports(const RunFigures& figures, OutputFolder& out);
void print_summary(const RunFigures& figures, const OutputFolder& out);

}  // namespace pliant
