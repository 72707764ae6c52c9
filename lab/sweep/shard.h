// The share of a plan's runs that this process executes.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "runtime/result.h"

namespace pliant {

struct Shard {
  std::size_t number = 1, count = 1;  // number in [1, count]
  std::string from;                   // source variables; empty: an argument, or no shard given
  bool has(std::size_t run) const { return run % count == number - 1; }
  std::string file() const;  // file name of its lines
};

// I/N from `argument` if given. Else, from the environment `variable` (nullptr: not set), a Slurm array task, a rank
// (of MPI, or a task of srun), or both (each array task has its own ranks). Else all runs.
Result<Shard> choose_shard(const std::string& argument, const std::function<const char*(const char*)>& variable);

}  // namespace pliant
