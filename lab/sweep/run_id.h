// Identity of a run across sweeps: the level's scene hash, its error budgets and the keys that it sets itself, the
// arguments, the contents (not the locations) of the files they name, and the version.
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
  std::vector<std::string> arguments;  // after LEVEL; file names relative to the plan's folder
};

struct ExpandedPlan {
  std::string level_name;
  std::string level_hash;  // 16 hexadecimal digits
  std::vector<SweepRun> runs;
};

// Loads the level once and checks settings and probes on it. The first axis value that is valid in no run is an error
// with its place in the plan.
Result<ExpandedPlan> expand_plan(const SweepPlan& plan);

}  // namespace pliant
