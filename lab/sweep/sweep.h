// `pliant sweep`: one level with many settings, one run each, in parallel processes and on several machines
// (docs/sweep.md).
#pragma once

#include <string>
#include <vector>

#include "lab/sweep/plan.h"

namespace pliant {

struct SweepOptions {
  std::string plan;   // file
  std::string out;    // folder of the lines; empty: out/<plan's name>
  std::string shard;  // I/N; empty: from the environment, else all runs
  bool retry_failed = false;
  bool list = false, dry_run = false;  // write nothing
  unsigned jobs = 1;                   // concurrent runs
  CheckArguments check = nullptr;      // of the command that executes them
};
int sweep(const SweepOptions& options);

struct MergeOptions {
  std::vector<std::string> folders;  // folders with lines
  std::string out;
  bool force = false;  // replace an earlier merge's files
};
int merge_sweep(const MergeOptions& options);

}  // namespace pliant
