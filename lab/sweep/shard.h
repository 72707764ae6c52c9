// Which share of a plan's runs this process does.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "runtime/result.h"

namespace pliant {

struct Shard {
  std::size_t number = 1, count = 1;  // number in [1, count]
  std::string from;                   // the variables that said so; empty: an argument, or nobody
  bool has(std::size_t run) const { return run % count == number - 1; }
  std::string file() const;  // of its lines
};

// I/N where `argument` has it. Else a Slurm array's task, a rank (of MPI, or a task of srun), or both (each task of the
// array has its own ranks), by `variable`, which is the environment; nullptr is a variable that is not set. Else
// everything.
Result<Shard> choose_shard(const std::string& argument, const std::function<const char*(const char*)>& variable);

}  // namespace pliant
