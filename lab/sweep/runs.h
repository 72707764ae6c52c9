// Does runs of a plan, some at a time, and adds a line for each to the shard's file.
#pragma once

#include <filesystem>
#include <vector>

#include "lab/console/interrupt.h"
#include "lab/sweep/lines.h"
#include "lab/sweep/shard.h"

namespace pliant {

struct RunsDone {
  std::size_t done = 0, failed = 0;
};

// Where runs are started: arguments name files from there.
std::filesystem::path run_folder(const SweepPlan& plan);
// Where the forces of a run over time are kept: the run's forces.csv.
std::filesystem::path curve_of(const std::filesystem::path& folder, const std::string& id);
// The command of a run, after `pliant`. `out`: its folder.
std::vector<std::string> command_of(const SweepPlan& plan, const SweepRun& run, const std::string& out, unsigned jobs);

// `wanted`: numbers in `expanded`; `before`: what there was when `lines` had been opened. Ends early, with what was
// done, when that is requested. A run that ended because a disk is full has no line, and is an error.
Result<RunsDone> do_runs(const SweepPlan& plan, const ExpandedPlan& expanded, const std::vector<std::size_t>& wanted,
                         const Lines& before, LineFile& lines, const std::filesystem::path& folder, const Shard& shard,
                         unsigned jobs, const Interrupt& interrupt);

}  // namespace pliant
