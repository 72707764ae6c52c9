// Arguments in, exit status out.
#pragma once

#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

int command_line(int argc, const char* const* argv);

// Whether `pliant` takes these words, and `pliant run` these options; the error is what it would say. Nothing runs.
Status check_arguments(const std::vector<std::string>& words);
Status check_run_arguments(const std::vector<std::string>& arguments);

}  // namespace pliant
