// stdin, stdout and stderr as a command finds them: open, closed, or a pipe that nobody reads any more.
#pragma once

#include <optional>
#include <string>

#include "runtime/result.h"

namespace pliant {

// Call first. A closed standard stream becomes /dev/null: the next file that is opened would otherwise get its number,
// and what is printed would land in that file. A broken pipe and a file at its size limit (`ulimit -f`) become errors
// of a write instead of signals that kill. Where the parent ignored SIGCHLD this does not: else nobody would learn how
// a process of ours ended.
void prepare_standard_streams();

// Call last. What was printed and could not be written.
std::optional<Error> close_stdout();

}  // namespace pliant
