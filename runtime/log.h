// One way out for what the library says beside its results (pliant/process.h). Never from a tick.
#pragma once

#include "pliant/process.h"

namespace pliant {

void log_sentence(LogLevel level, const std::string& sentence);

}  // namespace pliant
