#include "devices/guard/last_resort.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <mutex>

namespace pliant {
namespace {

constexpr int kCrashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr int kRequests[] = {SIGTERM, SIGINT, SIGHUP};

std::array<std::atomic<Driver*>, 64> open_drivers{};
std::atomic<bool> ended{false};
struct sigaction before[NSIG];

// Calls only lock-free atomics, make_safe(), and the previous handler.
void on_signal(int signal) {
  make_devices_safe();
  sigaction(signal, &before[signal], nullptr);
  raise(signal);  // delivered when this handler returns
}

void install() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (const int signal : kCrashes) sigaction(signal, &action, &before[signal]);
  for (const int signal : kRequests) {
    sigaction(signal, nullptr, &before[signal]);
    if (!(before[signal].sa_flags & SA_SIGINFO) && before[signal].sa_handler == SIG_DFL)
      sigaction(signal, &action, nullptr);
  }
}

}  // namespace

bool guard_to_the_last(Driver& driver) {
  static std::once_flag once;
  std::call_once(once, [] { std::atexit([] { make_devices_safe(); }); });
  for (std::atomic<Driver*>& slot : open_drivers) {
    Driver* none = nullptr;
    if (slot.compare_exchange_strong(none, &driver)) return true;
  }
  return false;
}

void let_go_of(Driver& driver) {
  for (std::atomic<Driver*>& slot : open_drivers) {
    Driver* mine = &driver;
    if (slot.compare_exchange_strong(mine, nullptr)) return;
  }
}

void make_devices_safe_on_signals() {
  static std::once_flag once;
  std::call_once(once, install);
}

void make_devices_safe() noexcept {
  ended = true;
  for (std::atomic<Driver*>& slot : open_drivers)
    if (Driver* const driver = slot.exchange(nullptr)) driver->make_safe();
}

bool all_made_safe() noexcept {
  return ended.load(std::memory_order_relaxed);
}

}  // namespace pliant
