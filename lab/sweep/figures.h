// What of a run's results goes into its line: figures that are the same every time, and apart from them those that are
// measured by the clock.
#pragma once

#include <filesystem>

#include "lab/sweep/axis.h"
#include "runtime/result.h"

namespace pliant {

struct RunResult {
  PlanJson figures;  // name -> number, and "hash"
  PlanJson timing;   // name -> number
  PlanJson notes;    // sentences: what the run did differently than one might expect
};
// Of report.json and forces.csv in a run's folder. Figures of a probe or tool have its name before them:
// tip.max_force_N.
Result<RunResult> read_run(const std::filesystem::path& folder);

}  // namespace pliant
