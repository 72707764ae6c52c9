// How the command ends: exit status 0 done, 1 the input or the run failed, 2 the arguments are wrong.
#pragma once

#include <exception>
#include <string>

#include "runtime/result.h"

namespace pliant {

enum ExitStatus : int { kDone = 0, kFailed = 1, kUsage = 2 };

// Prints `pliant: error: WHERE: what is wrong; what to do`, always one line, to stderr and returns the status.
int fail(ExitStatus status, const Error& error);

// What an exception that nobody below expected (most are a library's) says to a user.
Error explain(const std::exception& error);

// The error's sentence with its cure, as fail() prints it and the report has it.
std::string sentence_of(ExitStatus status, const Error& error);

// Prints `pliant: note: ...` to stderr: something was done differently than a user might expect.
void note(const std::string& sentence);
// The same without waiting for whoever reads stderr: left out where there is no room.
void note_at_once(const std::string& sentence);

}  // namespace pliant
