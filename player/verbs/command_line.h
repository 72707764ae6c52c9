// Parses the arguments, runs the verb and returns the exit status.
#pragma once

#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

int command_line(int argc, const char* const* argv);

// Checks whether `pliant` accepts these words, and `pliant run` these options. The error is the one it would print.
// Nothing is run.
Status check_arguments(const std::vector<std::string>& words);
Status check_run_arguments(const std::vector<std::string>& arguments);

}  // namespace pliant
