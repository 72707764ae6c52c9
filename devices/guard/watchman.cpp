#include "devices/guard/watchman.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <tuple>

namespace pliant {
namespace {

constexpr double kRenewEvery = 0.25;  // [s] of the line that a guard process holds
constexpr const char* kNoSafeLine =
    "nothing outside this program can switch its force off: if the program is killed (kill -9, out of memory), a force "
    "stands until the device's own watchdog ends it; keep a hand on its switch";
constexpr char kBeat = 'b', kEnd = 'e', kLine = 'l';

// One datagram of the pipe: a command, and for a line its bytes, with the file descriptor attached (SCM_RIGHTS).
struct Word {
  char what = 0;
  std::uint16_t size = 0;
  std::array<std::uint8_t, std::tuple_size_v<decltype(SafeLine::bytes)>> bytes{};
};
union Passed {  // one file descriptor, aligned as the kernel requires
  cmsghdr head;
  char room[CMSG_SPACE(sizeof(int))];
};

// -1: nothing arrived; 0: the other end is closed; else the command, and `line` if it contains one.
ssize_t hear(int pipe, Word& word, SafeLine& line) {
  iovec data{&word, sizeof word};
  Passed passed{};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = &passed;
  message.msg_controllen = sizeof passed;
  const ssize_t size = ::recvmsg(pipe, &message, MSG_DONTWAIT | MSG_CMSG_CLOEXEC);
  if (size <= 0) return size;
  const cmsghdr* const head = CMSG_FIRSTHDR(&message);
  if (!head || head->cmsg_type != SCM_RIGHTS) return size;
  int descriptor = -1;
  std::memcpy(&descriptor, CMSG_DATA(head), sizeof descriptor);
  if (line.descriptor >= 0) ::close(line.descriptor);
  line.descriptor = descriptor;
  line.size = std::min<std::size_t>(word.size, line.bytes.size());
  line.bytes = word.bytes;
  return size;
}

// Only system calls from here on: safe in a process forked from one with threads.
[[noreturn]] void watch(int pipe, SafeLine line, int waits_ms) {
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_IGN);  // it ends with its parent, not before
  ::setsid();
#ifdef SYS_close_range
  // Close all other descriptors, which would otherwise stay open with it.
  const auto low = static_cast<unsigned>(std::min(pipe, line.descriptor));
  const auto high = static_cast<unsigned>(std::max(pipe, line.descriptor));
  if (low > 0) ::syscall(SYS_close_range, 0u, low - 1, 0u);
  if (high - low > 1) ::syscall(SYS_close_range, low + 1, high - 1, 0u);
  ::syscall(SYS_close_range, high + 1, ~0u, 0u);
#endif
  const auto make_safe = [&] {
    for (int tries = 0; tries < 3; ++tries)
      if (::syscall(SYS_write, line.descriptor, line.bytes.data(), line.size) == static_cast<long>(line.size)) return;
  };
  bool silent = true;  // the watchdog starts with the first heartbeat
  for (;;) {
    pollfd watched{pipe, POLLIN, 0};
    const int got = ::poll(&watched, 1, silent ? -1 : waits_ms);
    if (got == 0) {
      silent = true;
      make_safe();
      continue;
    }
    if (got < 0 && errno == EINTR) continue;
    Word word;
    const ssize_t size = hear(pipe, word, line);
    if (size < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (size <= 0) {  // the other end is closed
      make_safe();
      ::_exit(0);
    }
    if (word.what == kEnd) ::_exit(0);
    silent = false;
  }
}

}  // namespace

Status Watchman::start(const SafeLine& line, double waits) {
  end();
  if (line.descriptor < 0 || line.size == 0 || line.size > line.bytes.size())
    return Error{"guard process", "the driver names no line to write on"};
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
    return Error{"guard process", std::string("no socket pair (") + std::strerror(errno) + ")", "raise ulimit -n"};
  const pid_t child = ::fork();
  if (child < 0) {
    ::close(ends[0]), ::close(ends[1]);
    return Error{"guard process", std::string("no process (") + std::strerror(errno) + ")", "raise ulimit -u"};
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
  // If the pipe is full, it already contains enough heartbeats.
  [[maybe_unused]] const ssize_t sent = ::send(pipe_, &kBeat, 1, MSG_NOSIGNAL | MSG_DONTWAIT);
}

void Watchman::renew(const SafeLine& line) noexcept {
  if (pipe_ < 0 || line.descriptor < 0 || line.size == 0 || line.size > line.bytes.size()) return;
  Word word{kLine, static_cast<std::uint16_t>(line.size), line.bytes};
  iovec data{&word, sizeof word};
  Passed passed{};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = &passed;
  message.msg_controllen = CMSG_LEN(sizeof(int));
  passed.head.cmsg_level = SOL_SOCKET;
  passed.head.cmsg_type = SCM_RIGHTS;
  passed.head.cmsg_len = CMSG_LEN(sizeof(int));
  std::memcpy(CMSG_DATA(&passed.head), &line.descriptor, sizeof(int));
  [[maybe_unused]] const ssize_t sent = ::sendmsg(pipe_, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
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

std::string LineWatch::start(const Driver& driver, const DeviceCapabilities& can) {
  reported_at_ = 0.0;
  SafeLine line;
  if (!driver.safe_line(line)) return renders(can) && !can.simulated ? kNoSafeLine : "";
  const Status started = watchman_.start(line);
  return started ? std::string() : started.error().message();
}

// A device that was opened anew has another line, or other words for zero.
void LineWatch::beat(const Driver& driver, double now) noexcept {
  if (!watchman_.watches()) return;
  watchman_.beat();
  if (now - reported_at_ < kRenewEvery) return;
  reported_at_ = now;
  SafeLine line;
  if (driver.safe_line(line)) watchman_.renew(line);
}

bool renders(const DeviceCapabilities& can) {
  return can.renders_force || can.renders_torque || can.renders_grip || can.renders_vibration;
}

}  // namespace pliant
