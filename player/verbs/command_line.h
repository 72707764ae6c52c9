// Arguments in, exit status out.
#pragma once

#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant {

int command_line(int argc, const char* const* argv);

// Whether `pliant run` takes these options with these values; the error is what it would say. Nothing runs.
Status check_run_arguments(const std::vector<std::string>& arguments);

}  // namespace pliant
