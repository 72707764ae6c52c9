// Makes every open device safe when the program dies; from a signal handler if the program has asked for it
// (pliant/process.h).
//
// SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT (a crash, std::terminate, an assertion), and SIGTERM, SIGINT and SIGHUP if
// unhandled, first call Driver::make_safe() of every open device, then take their previous action. A normal exit() does
// so in any case. Events that cannot be caught (kill -9, power loss) are covered from outside: by a guard process
// (watchman.h) and the device's own watchdog.
#pragma once

#include "pliant/driver.h"
#include "pliant/process.h"

namespace pliant {

// From any thread. At most 64 devices; further ones are not covered, and it returns false.
bool guard_to_the_last(Driver& driver);
void let_go_of(Driver& driver);
// True once make_devices_safe() ran.
bool all_made_safe() noexcept;

}  // namespace pliant
