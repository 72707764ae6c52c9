// Exit status of the command: 0 success, 1 the input or the run failed, 2 wrong arguments, 3 no room on the disk for
// what it wrote.
#pragma once

#include <exception>
#include <string>

#include "runtime/result.h"

namespace pliant {

enum ExitStatus : int { kDone = 0, kFailed = 1, kUsage = 2, kNoRoom = 3 };

// Prints `pliant: error: WHERE: what is wrong; what to do` on one line to stderr and returns the status: kNoRoom where
// the error's code is kDiskFull.
int fail(ExitStatus status, const Error& error);

// Turns an unexpected exception (usually from a library) into an Error for the user.
Error explain(const std::exception& error);

// The error's sentence with its remedy, as fail() prints it and report.json stores it.
std::string sentence_of(ExitStatus status, const Error& error);

// Prints `pliant: note: ...` to stderr: the command did something that the user might not expect.
void note(const std::string& sentence);
// The same without blocking: the note is dropped if stderr cannot take it at once.
void note_at_once(const std::string& sentence);

}  // namespace pliant
