// What the library does to the process that it is in. By itself: no signal handler is installed, and nothing is written
// to stdout or stderr but warnings and the last sentence before an abort. A program that wants more, or less, says so
// here.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace pliant {

enum class LogLevel : std::uint8_t {
  kInfo,     // a call takes long; dropped unless there is a hook
  kWarning,  // something was lost that no returned value can say; "pliant: SENTENCE" on stderr unless there is a hook
  kFatal     // an assertion failed, and std::abort() follows; the same
};
// One sentence, without a line end. From any thread, but never from a tick; it must not throw.
using LogHook = std::function<void(LogLevel level, const std::string& sentence)>;
// From now on the library says everything to `hook`; an empty one: as above. From any thread.
void set_log(LogHook hook);

// Every open device that has a servo is made safe (Driver::make_safe), and no servo writes any more until the program
// ends. May be called from a signal handler. A program's normal exit() does it, too.
void make_devices_safe() noexcept;
// Opt-in: crashes (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT), and SIGTERM, SIGINT and SIGHUP where they have no handler
// yet, first go through make_devices_safe(), then the way they would have gone. Once; handlers that the program
// installs afterwards replace these and should call make_devices_safe() themselves.
void make_devices_safe_on_signals();

}  // namespace pliant
