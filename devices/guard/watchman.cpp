#include "devices/guard/watchman.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>

namespace pliant {
namespace {

constexpr char kBeat = 'b', kEnd = 'e';

// All that it does from here on is safe in a process that was forked from one with threads: system calls alone.
[[noreturn]] void watch(int pipe, const SafeLine& line, int waits_ms) {
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_IGN);  // it ends with its parent, not before
  ::setsid();
#ifdef SYS_close_range
  // The lines of everything else would stay open with it.
  const auto low = static_cast<unsigned>(std::min(pipe, line.descriptor));
  const auto high = static_cast<unsigned>(std::max(pipe, line.descriptor));
  if (low > 0) ::syscall(SYS_close_range, 0u, low - 1, 0u);
  if (high - low > 1) ::syscall(SYS_close_range, low + 1, high - 1, 0u);
  ::syscall(SYS_close_range, high + 1, ~0u, 0u);
#endif
  const auto make_safe = [&] {
    for (int tries = 0; tries < 3; ++tries)
      if (::write(line.descriptor, line.bytes.data(), line.size) == static_cast<ssize_t>(line.size)) return;
  };
  bool silent = true;  // nothing to end before the first beat
  for (;;) {
    pollfd watched{pipe, POLLIN, 0};
    const int got = ::poll(&watched, 1, silent ? -1 : waits_ms);
    if (got == 0) {
      silent = true;
      make_safe();
      continue;
    }
    if (got < 0 && errno == EINTR) continue;
    char beats[256];
    const ssize_t size = ::read(pipe, beats, sizeof beats);
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (size <= 0) {  // the other end is gone
      make_safe();
      ::_exit(0);
    }
    if (std::memchr(beats, kEnd, static_cast<std::size_t>(size))) ::_exit(0);
    silent = false;
  }
}

}  // namespace

Status Watchman::start(const SafeLine& line, double waits) {
  end();
  if (line.descriptor < 0 || line.size == 0 || line.size > line.bytes.size())
    return Error{"guard process", "the driver names no line to write on"};
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
    return Error{"guard process", std::string("no socket pair (") + std::strerror(errno) + "); raise ulimit -n"};
  const pid_t child = ::fork();
  if (child < 0) {
    ::close(ends[0]), ::close(ends[1]);
    return Error{"guard process", std::string("no process (") + std::strerror(errno) + "); raise ulimit -u"};
  }
  if (child == 0) {
    ::close(ends[1]);
    watch(ends[0], line, std::max(1, static_cast<int>(std::lround(waits * 1e3))));
  }
  ::close(ends[0]);
  pipe_ = ends[1];
  child_ = child;
  return Done{};
}

void Watchman::beat() noexcept {
  if (pipe_ < 0) return;
  // A full one has beats enough in it.
  [[maybe_unused]] const ssize_t sent = ::send(pipe_, &kBeat, 1, MSG_NOSIGNAL | MSG_DONTWAIT);
}

void Watchman::end() noexcept {
  if (pipe_ < 0) return;
  [[maybe_unused]] const ssize_t sent = ::send(pipe_, &kEnd, 1, MSG_NOSIGNAL | MSG_DONTWAIT);
  ::close(pipe_);
  pipe_ = -1;
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
}

}  // namespace pliant
