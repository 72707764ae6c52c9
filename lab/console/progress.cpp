#include "lab/console/progress.h"

#include <unistd.h>

#include <atomic>
#include <cstdio>

#include "lab/console/exit.h"
#include "runtime/clock.h"
#include "runtime/log.h"
#include "runtime/printable.h"

namespace pliant {
namespace {
constexpr double kQuiet = 1.0;       // [s] before the first message
constexpr double kOnTerminal = 0.2;  // [s] between two updates on a terminal
constexpr double kElsewhere = 5.0;   // [s]
std::atomic<bool> g_line{false};     // process-global, like the terminal
std::atomic<int> g_shown{0};         // number of live Progress objects
double seconds(std::uint64_t nanoseconds) {
  return static_cast<double>(nanoseconds) * 1e-9;
}
}  // namespace

Progress::Progress(std::string what)
    : what_(std::move(what)), terminal_(::isatty(STDERR_FILENO) == 1), begin_(now_ns()), last_(begin_) {
  ++g_shown;
}

void log_to_stderr() {
  set_log([](LogLevel level, const std::string& sentence) {
    if (level == LogLevel::kWarning) return note(sentence);
    if (level == LogLevel::kInfo && g_shown > 0) return;
    std::fprintf(stderr, "pliant: %s\n", printable(sentence).c_str());
  });
}

bool progress_line_stands() {
  return g_line;
}

Progress::~Progress() {
  --g_shown;
  if (shown_ && terminal_) std::fputs("\r\x1b[K", stderr);
  g_line = false;
}

void Progress::update(double share) {
  const std::uint64_t now = now_ns();
  const double elapsed = seconds(now - begin_);
  if (elapsed < kQuiet || seconds(now - last_) < (terminal_ ? kOnTerminal : kElsewhere)) return;
  last_ = now;
  shown_ = true;
  g_line = terminal_;
  const double left = share > 0.0 ? elapsed * (1.0 - share) / share : 0.0;
  std::fprintf(stderr, terminal_ ? "\r\x1b[K%s: %3.0f %%, %.0f s left" : "%s: %3.0f %%, %.0f s left\n",
               printable(what_).c_str(), share * 100.0, left);
  std::fflush(stderr);
}

}  // namespace pliant
