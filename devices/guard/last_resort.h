// When the program dies: every open device is made safe once more, from a signal handler where the program has asked
// for one (pliant/process.h).
//
// What holds then: SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT (a crash, std::terminate, an assertion), and SIGTERM,
// SIGINT and SIGHUP where the program handles them not, go through Driver::make_safe() of every open device, and then
// the way they would have gone. A normal exit() does so in any case. What cannot be caught (kill -9, power) is for what
// stands outside: a guard process (watchman.h), the device's own watchdog, its silence.
#pragma once

#include "pliant/driver.h"
#include "pliant/process.h"

namespace pliant {

// From any thread. At most 64 at once: more are not looked after, which is false.
bool guard_to_the_last(Driver& driver);
void let_go_of(Driver& driver);
// True once make_devices_safe() ran.
bool all_made_safe() noexcept;

}  // namespace pliant
