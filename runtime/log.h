// The only output of the library besides its results (pliant/process.h). Never called from a tick.
#pragma once

#include "pliant/process.h"

namespace pliant {

void log_sentence(LogLevel level, const std::string& sentence);

}  // namespace pliant
