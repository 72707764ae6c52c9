// `pliant sweep`: one level over many settings, each a run of its own, in as many processes and on as many machines as
// there are (docs/sweep.md).
#pragma once

#include <string>
#include <vector>

#include "lab/sweep/plan.h"

namespace pliant {

struct SweepOptions {
  std::string plan;   // file
  std::string out;    // folder of the lines; empty: out/<plan's name>
  std::string shard;  // I/N; empty: from the environment, else all
  bool retry_failed = false;
  bool list = false, dry_run = false;  // write nothing
  unsigned jobs = 1;                   // runs at a time
  CheckArguments check = nullptr;      // of the command that does them
};
int sweep(const SweepOptions& options);

struct MergeOptions {
  std::vector<std::string> folders;  // of lines
  std::string out;
  bool force = false;  // replaces what an earlier merge wrote
};
int merge_sweep(const MergeOptions& options);

}  // namespace pliant
