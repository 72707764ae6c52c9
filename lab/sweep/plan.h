// A sweep's plan as read from its file (docs/sweep.md), and the runs that it stands for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/sweep/axis.h"
#include "runtime/result.h"

namespace pliant {

struct SweepPlan {
  std::filesystem::path file;
  std::filesystem::path level;                               // that exists
  std::vector<std::pair<std::string, std::string>> options;  // --name and value of each, "" of a flag; sorted by name
  std::vector<SweepAxis> axes;                               // the steps' first, each in the order of the file
  std::size_t samples = 1;                                   // of the Latin hypercube
  double timeout = 0.0;                                      // [s] of a run by the clock on the wall; 0: none
  bool keep_curves = false;                                  // forces.csv of every run, too

  std::size_t count() const;  // runs: at most kMostRuns
  // The value of each axis. The first axis changes slowest, the sample fastest.
  std::vector<PlanJson> values_of(std::size_t run) const;
};

// The arguments after LEVEL of a run: options, --set of the plan, --set of the axes (those of all nodes first, then by
// name). Files are as they stand in the plan, from whose folder runs are started.
std::vector<std::string> arguments_of(const SweepPlan& plan, const std::vector<PlanJson>& values);

// The file that an argument names (a probe's script, a recording), and where in the argument its name stands.
struct ArgumentFile {
  std::filesystem::path path;  // found from the plan's folder; empty: it names none
  std::size_t begin = 0, size = 0;
};
ArgumentFile file_in(const SweepPlan& plan, const std::string& argument);

// Whether `pliant run` takes these options with these values; the error is what it would say. Nothing runs.
using CheckArguments = Status (*)(const std::vector<std::string>& arguments);

// Unknown keys are refused by name. `check` tries options and their values.
Result<SweepPlan> read_plan(const std::filesystem::path& file, CheckArguments check);

}  // namespace pliant
