// What makes two runs of sweeps the same run: the level as it is felt, its error budgets and what they leave open, the
// arguments, what is in the files that these name (not where they lie), the version.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lab/sweep/plan.h"
#include "runtime/result.h"

namespace pliant {

struct SweepRun {
  std::string id;                      // 16 hexadecimal digits
  std::vector<PlanJson> values;        // of the axes
  std::vector<std::string> arguments;  // after LEVEL; files from the plan's folder
};

struct ExpandedPlan {
  std::string level_name;
  std::string level_hash;  // 16 hexadecimal digits
  std::vector<SweepRun> runs;
};

// Loads the level once. Settings and probes are tried on it: the first value of an axis that no run can have is an
// error with its place in the plan.
Result<ExpandedPlan> expand_plan(const SweepPlan& plan);

}  // namespace pliant
