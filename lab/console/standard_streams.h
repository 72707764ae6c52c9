// Standard streams as the command finds them: open, closed, or a broken pipe.
#pragma once

#include <optional>
#include <string>

#include "runtime/result.h"

namespace pliant {

// Call first. A closed standard stream becomes /dev/null: otherwise the next opened file would get its number and
// receive the printed text. A broken pipe and a file at its size limit (`ulimit -f`) become write errors instead of
// fatal signals. SIGCHLD is restored if the parent ignored it: otherwise the exit status of a child process is lost.
void prepare_standard_streams();

// Call last. The error if printed text could not be written.
std::optional<Error> close_stdout();

}  // namespace pliant
