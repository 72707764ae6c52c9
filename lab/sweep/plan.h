// A sweep's plan as read from its file (docs/sweep.md), and its runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/sweep/axis.h"
#include "runtime/result.h"

namespace pliant {

struct SweepPlan {
  std::filesystem::path file;
  std::filesystem::path level;                               // an existing file
  std::vector<std::pair<std::string, std::string>> options;  // --name and value of each, "" for a flag; sorted by name
  std::vector<SweepAxis> axes;                               // axes of steps first, each in the order of the file
  std::size_t samples = 1;                                   // of the Latin hypercube
  double timeout = 0.0;                                      // [s] wall-clock limit of a run; 0: none
  bool keep_curves = false;                                  // also keep forces.csv of every run

  std::size_t count() const;  // number of runs, at most kMostRuns
  // The value of each axis. The first axis changes slowest, the sample fastest.
  std::vector<PlanJson> values_of(std::size_t run) const;
};

// The arguments of a run after LEVEL: options, --set of the plan, --set of the axes (those of all nodes first, then by
// name). File names are as in the plan; runs start in the plan's folder.
std::vector<std::string> arguments_of(const SweepPlan& plan, const std::vector<PlanJson>& values);

// The file that an argument names (a probe's script, a recording), and the position of the name in the argument.
struct ArgumentFile {
  std::filesystem::path path;  // relative to the plan's folder; empty: no file
  std::size_t begin = 0, size = 0;
};
ArgumentFile file_in(const SweepPlan& plan, const std::string& argument);

// Checks whether `pliant run` accepts these options and values; the error is that of `pliant run`. Nothing is run.
using CheckArguments = Status (*)(const std::vector<std::string>& arguments);

// Unknown keys are rejected by name. `check` validates options and their values.
Result<SweepPlan> read_plan(const std::filesystem::path& file, CheckArguments check);

}  // namespace pliant
