#include "content/files/isolation.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>

#include "runtime/long_work.h"

namespace pliant {

namespace {

constexpr double kPatience = 30.0;       // [1] wall-clock limit of a child, as a multiple of its CPU time limit
constexpr double kLeastPatience = 60.0;  // [s] lower bound of that limit
constexpr auto kStandsStill = std::chrono::seconds(4);
constexpr std::int64_t kLook = 100;  // [ms] between two checks of a child that writes nothing
constexpr int kAttempts = 3;         // the last one has no stall detection

constexpr char kDone = 'D', kRefused = 'R';

// [byte] private memory of this process, and so of the child at its start.
std::uint64_t private_bytes() {
  std::uint64_t pages[6] = {};
  std::ifstream in("/proc/self/statm");
  for (std::uint64_t& each : pages) in >> each;
  return pages[5] * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

bool write_all(int end, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(end, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

// The kernel sends SIGPROF after this CPU time, with microsecond resolution; RLIMIT_CPU counts whole seconds.
// RLIMIT_CPU is the fallback if a library takes over SIGPROF.
void end_after(double seconds) {
  const double whole = std::floor(seconds);
  const itimerval timer{{0, 0}, {static_cast<time_t>(whole), static_cast<suseconds_t>((seconds - whole) * 1e6)}};
  setitimer(ITIMER_PROF, &timer, nullptr);
  const auto most = static_cast<rlim_t>(std::ceil(seconds)) + 1;
  const rlimit limit{most, most + 1};
  setrlimit(RLIMIT_CPU, &limit);
}

// Sends the parts of an error: each with its length before it.
bool refuse(int end, const Error& error) {
  Bytes out;
  for (const std::string* part : {&error.where, &error.what, &error.cure, &error.code}) {
    const std::uint64_t size = part->size();
    append_bytes(out, &size, sizeof size);
    append_bytes(out, part->data(), size);
  }
  return write_all(end, &kRefused, 1) && write_all(end, out.data(), out.size());
}

[[noreturn]] void child(int end, std::uint64_t memory, double seconds, const std::function<Result<Bytes>()>& work) {
#ifndef PLIANT_SANITIZED  // sanitizers reserve more address space than any limit
  const rlimit limit{memory, memory};
  setrlimit(RLIMIT_DATA, &limit);
#else
  (void)memory;
#endif
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGPIPE, SIGPROF, SIGXCPU})
    ::signal(signal, SIG_DFL);
  sigset_t profile;
  sigemptyset(&profile);
  sigaddset(&profile, SIGPROF);
  sigprocmask(SIG_UNBLOCK, &profile, nullptr);
  end_after(seconds);
  // Hide what the library prints when it crashes.
  (void)!std::freopen("/dev/null", "w", stderr);
  bool sent = false;
  try {
    const Result<Bytes> result = work();
    sent = result ? write_all(end, &kDone, 1) && write_all(end, result->data(), result->size())
                  : refuse(end, result.error());
  } catch (const std::bad_alloc&) {
    sent =
        refuse(end, {"", "needs more memory than a file of this size may use", "simplify it, or convert it to glTF"});
  } catch (const std::exception& e) {
    sent = refuse(end, {"", std::string("cannot be read: ") + e.what()});
  }
  _exit(sent ? 0 : 1);
}

// The inverse of refuse().
Error refusal(const Bytes& answer) {
  Error error;
  Taker in(answer);
  for (std::string* part : {&error.where, &error.what, &error.cure, &error.code}) {
    std::uint64_t size = 0;
    if (!in.take(&size, sizeof size) || size > in.rest().size()) break;
    part->resize(size);
    in.take(part->data(), size);
  }
  return error;
}

using Clock = std::chrono::steady_clock;

// [s] CPU time of a process; negative: unknown.
double processor_time(pid_t pid) {
  clockid_t clock;
  timespec used{};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &used) != 0) return -1.0;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

// How a child ended.
struct Ended {
  Bytes answer;
  int status = 0;
  double seconds = 0.0;  // CPU time
  bool late = false;     // killed at the deadline
  bool stuck = false;    // killed because it made no progress
};

// Reads the child's output until it ends. `watch`: detect a deadlocked child. If it neither writes nor uses the CPU for
// kStandsStill, it was forked while another thread held a lock that it waits for.
Ended wait_for(pid_t pid, int end, Clock::time_point deadline, bool watch) {
  Ended out;
  LongWork work;
  std::vector<std::uint8_t> buffer(1 << 20);
  double used = 0.0;
  Clock::time_point moved = Clock::now();
  while (true) {
    try {
      work.say("reading");
    } catch (const WorkStopped&) {
      kill(pid, SIGKILL);
      while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
      }
      close(end);
      throw;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd ready{end, POLLIN, 0};
    const int polled = left > 0 ? poll(&ready, 1, static_cast<int>(std::min<std::int64_t>(left, kLook))) : 0;
    if (polled < 0 && errno == EINTR) continue;
    if (polled < 0 || left <= 0) {
      out.late = true;
      break;
    }
    if (polled == 0) {
      const double now = processor_time(pid);
      if (now < 0.0 || now > used + 1e-3) used = now, moved = Clock::now();
      out.stuck = watch && Clock::now() - moved > kStandsStill;
      if (out.stuck) break;
      continue;
    }
    const ssize_t got = read(end, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    out.answer.insert(out.answer.end(), buffer.begin(), buffer.begin() + got);
    moved = Clock::now();
  }
  if (out.late || out.stuck) kill(pid, SIGKILL);
  rusage usage{};
  while (wait4(pid, &out.status, 0, &usage) < 0 && errno == EINTR) {
  }
  for (const timeval& part : {usage.ru_utime, usage.ru_stime})
    out.seconds += static_cast<double>(part.tv_sec) + 1e-6 * static_cast<double>(part.tv_usec);
  return out;
}

}  // namespace

Result<Bytes> in_isolation(std::size_t input_bytes, const std::function<Result<Bytes>()>& work, double seconds,
                           double wall, double* used) {
  const double allowed = (seconds + reading_time(input_bytes)) * std::max(limit_factor(), 1.0);  // [s] of CPU time
  const double wait = wall > 0.0 ? wall : std::max(kPatience * allowed, kLeastPatience);
  const auto deadline = Clock::now() + std::chrono::milliseconds(static_cast<std::int64_t>(wait * 1e3));
  const std::uint64_t memory = private_bytes() + most(limits::kReaderMemory) + 64 * std::uint64_t{input_bytes};
  Ended ended;
  for (int attempt = 1; attempt == 1 || ended.stuck; ++attempt) {
    int ends[2];
    if (pipe(ends) != 0)
      return Error{"", std::string("cannot be read: no pipe: ") + std::strerror(errno), "close other programs"};
    const pid_t pid = fork();
    if (pid < 0) {
      close(ends[0]), close(ends[1]);
      return Error{"", std::string("cannot be read: no process: ") + std::strerror(errno), "close other programs"};
    }
    if (pid == 0) {
      close(ends[0]);
      child(ends[1], memory, allowed, work);
    }
    close(ends[1]);
    ended = wait_for(pid, ends[0], deadline, attempt < kAttempts);
    close(ends[0]);
    if (used) *used += ended.seconds;
  }
  const int status = ended.status;
  const bool spent = WIFSIGNALED(status) && (WTERMSIG(status) == SIGPROF || WTERMSIG(status) == SIGXCPU);
  if (ended.late || spent) return Error{"", "takes too long to read", "the file is damaged, or too large"};
  Bytes& answer = ended.answer;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty())
    return Error{"", "crashed the importer", "the file is damaged, export it again"};
  const char verdict = static_cast<char>(answer.front());
  answer.erase(answer.begin());
  if (verdict == kDone) return std::move(answer);
  return refusal(answer);
}

}  // namespace pliant
