// Effects of the library on its process. By default it installs no signal handler, and writes only warnings and the
// message of a failed assertion to stderr. The functions here change that.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace pliant {

enum class LogLevel : std::uint8_t {
  kInfo,     // a long-running call; dropped unless there is a hook
  kWarning,  // data was lost that no return value can report; "pliant: SENTENCE" on stderr unless there is a hook
  kFatal     // an assertion failed, and std::abort() follows; output as for kWarning
};
// One sentence, without a line end. Called from any thread, but never from a tick; must not throw.
using LogHook = std::function<void(LogLevel level, const std::string& sentence)>;
// Sends all messages to `hook`; an empty one restores the default. From any thread.
void set_log(LogHook hook);

// Makes every open device with a servo safe (Driver::make_safe), and stops all servos from writing until the program
// ends. May be called from a signal handler. Also called by exit().
void make_devices_safe() noexcept;
// Opt-in: crashes (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT), and SIGTERM, SIGINT and SIGHUP if they have no handler
// yet, first call make_devices_safe(), then take their previous action. Call once. Handlers installed later replace
// these and should call make_devices_safe() themselves.
void make_devices_safe_on_signals();

}  // namespace pliant
