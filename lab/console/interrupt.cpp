#include "lab/console/interrupt.h"

#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <thread>
#include <vector>

#include "lab/console/exit.h"
#include "runtime/clock.h"

namespace pliant {
namespace {

constexpr std::uint64_t kOnePress = 300'000'000;  // [ns] signals closer than this are one Ctrl-C
constexpr int kForcedPress = 3;
constexpr int kRemoveAttempts = 5;  // a thread may still write into a folder that is being removed

// Process-global, because a signal handler takes no state argument.
std::atomic<bool> g_requested{false};
std::atomic<bool> g_pressed{false};    // SIGINT arrived since the watcher last checked
std::atomic<bool> g_signalled{false};  // any of the signals arrived
sem_t g_arrived;                       // wakes the watcher
// Ctrl-C presses after the run.
std::atomic<int> g_late{0};
std::atomic<std::uint64_t> g_late_at{0};  // [ns]
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int signal) {
  const int kept = errno;
  g_requested = g_signalled = true;
  if (signal == SIGINT) g_pressed = true;
  sem_post(&g_arrived);
  errno = kept;
}

// The run has ended on request, and the process is about to end: further signals do not change its exit. If it hangs,
// kForcedPress presses end it.
void on_late_signal(int signal) {
  const std::uint64_t now = now_ns(), before = g_late_at.exchange(now);
  if (signal == SIGINT && now - before > kOnePress && ++g_late == kForcedPress) ::_exit(128 + SIGINT);
}

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

}  // namespace

struct Interrupt::State {
  InterruptWords words;
  std::mutex mutex;  // guards the two members below
  std::optional<Error> reason;
  std::vector<std::filesystem::path> staged;
  struct sigaction before[std::size(kSignals)] = {};
  std::atomic<bool> over{false};
  std::thread watcher;  // handles signals outside the handler, where any function may be called

  void watch() {
    std::uint64_t counted = 0;  // [ns] when the last press was counted
    for (int presses = 0; !over;) {
      while (sem_wait(&g_arrived) != 0 && errno == EINTR) {
      }
      if (over || !g_pressed.exchange(false)) continue;
      const std::uint64_t now = now_ns();
      if (presses > 0 && now - counted < kOnePress) continue;
      counted = now;
      if (++presses == kForcedPress) end_at_once();
      if (presses == kForcedPress - 1) note_at_once(words.second);
    }
  }

  [[noreturn]] void end_at_once() {
    const std::lock_guard lock(mutex);
    std::error_code error;
    for (auto at = staged.rbegin(); at != staged.rend(); ++at)
      for (int i = 0; i < kRemoveAttempts; ++i) {
        error.clear();
        std::filesystem::remove_all(*at, error);
        if (!error) break;
      }
    note_at_once(words.third);
    ::_exit(128 + SIGINT);
  }
};

Interrupt::Interrupt(InterruptWords words) : state_(std::make_unique<State>()) {
  state_->words = words;
  g_requested = g_pressed = g_signalled = false;
  sem_init(&g_arrived, 0, 0);
  state_->watcher = std::thread([state = state_.get()] { state->watch(); });
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < std::size(kSignals); ++i) {
    sigaction(kSignals[i], nullptr, &state_->before[i]);
    if (kSignals[i] != SIGTERM && state_->before[i].sa_handler == SIG_IGN) continue;
    sigaction(kSignals[i], &action, nullptr);
  }
}

Interrupt::~Interrupt() {
  struct sigaction late = {};
  late.sa_handler = on_late_signal;
  late.sa_flags = SA_RESTART;
  const bool signalled = g_signalled;
  g_late = 0;
  for (std::size_t i = 0; i < std::size(kSignals); ++i) {
    struct sigaction now = {};
    sigaction(kSignals[i], nullptr, &now);
    const bool ours = now.sa_handler == on_signal;
    if (ours) sigaction(kSignals[i], signalled ? &late : &state_->before[i], nullptr);
  }
  state_->over = true;
  sem_post(&g_arrived);
  state_->watcher.join();
}

bool Interrupt::requested() const {
  return g_requested;
}

void Interrupt::end(Error why) const {
  const std::lock_guard lock(state_->mutex);
  if (!state_->reason) state_->reason = std::move(why);
  g_requested = true;
}

std::optional<Error> Interrupt::reason() const {
  const std::lock_guard lock(state_->mutex);
  return state_->reason;
}

void Interrupt::remove_if_forced(std::filesystem::path staged) const {
  const std::lock_guard lock(state_->mutex);
  state_->staged.push_back(std::move(staged));
}

}  // namespace pliant
