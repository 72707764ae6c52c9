// The part of a run's results that goes into its line: reproducible figures, and separately those measured by the
// clock.
#pragma once

#include <filesystem>

#include "lab/sweep/axis.h"
#include "runtime/result.h"

namespace pliant {

struct RunResult {
  PlanJson figures;  // name -> number, and "hash"
  PlanJson timing;   // name -> number
  PlanJson notes;    // as in the report: where the run did something unexpected
};
// Reads report.json and forces.csv in a run's folder. Figures of a probe or tool are prefixed with its name:
// tip.max_force_N.
Result<RunResult> read_run(const std::filesystem::path& folder);

}  // namespace pliant
