// Executes runs of a plan, several at a time, and appends a line for each to the shard's file.
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

// Working directory of the runs: arguments name files relative to it.
std::filesystem::path run_folder(const SweepPlan& plan);
// The kept forces.csv of a run.
std::filesystem::path curve_of(const std::filesystem::path& folder, const std::string& id);
// The command line of a run, after `pliant`. `out`: its folder.
std::vector<std::string> command_of(const SweepPlan& plan, const SweepRun& run, const std::string& out, unsigned jobs);

// `wanted`: indices into `expanded`; `before`: the lines that existed when `lines` was opened. Stops early on
// interruption and returns what was done. A run that ended because of a full disk gets no line and is an error.
Result<RunsDone> do_runs(const SweepPlan& plan, const ExpandedPlan& expanded, const std::vector<std::size_t>& wanted,
                         const Lines& before, LineFile& lines, const std::filesystem::path& folder, const Shard& shard,
                         unsigned jobs, const Interrupt& interrupt);

}  // namespace pliant
