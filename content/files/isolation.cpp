#include "content/files/isolation.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>

namespace pliant {

namespace {

constexpr double kPatience = 30.0;       // [1] of its processor time that a child may take by the clock on the wall
constexpr double kLeastPatience = 60.0;  // [s]

constexpr char kDone = 'D', kRefused = 'R';

// What this process, and so the child at birth, has in private memory.
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

// The kernel sends SIGPROF once this process has used so much processor time: to the microsecond, where RLIMIT_CPU
// counts whole seconds. That stands behind it, against a library that takes SIGPROF for itself.
void end_after(double seconds) {
  const double whole = std::floor(seconds);
  const itimerval timer{{0, 0}, {static_cast<time_t>(whole), static_cast<suseconds_t>((seconds - whole) * 1e6)}};
  setitimer(ITIMER_PROF, &timer, nullptr);
  const auto most = static_cast<rlim_t>(std::ceil(seconds)) + 1;
  const rlimit limit{most, most + 1};
  setrlimit(RLIMIT_CPU, &limit);
}

[[noreturn]] void child(int end, std::uint64_t memory, double seconds, const std::function<Result<Bytes>()>& work) {
#ifndef PLIANT_SANITIZED  // sanitizers reserve more than any limit
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
  // A library's last words are not for the user.
  (void)!std::freopen("/dev/null", "w", stderr);
  bool sent = false;
  try {
    const Result<Bytes> result = work();
    const std::string sentence = result ? "" : result.error().where + '\n' + result.error().what;
    sent = result ? write_all(end, &kDone, 1) && write_all(end, result->data(), result->size())
                  : write_all(end, &kRefused, 1) && write_all(end, sentence.data(), sentence.size());
  } catch (const std::bad_alloc&) {
    const std::string sentence =
        "\nneeds more memory than a file of this size may use; simplify it, or convert it to glTF";
    sent = write_all(end, &kRefused, 1) && write_all(end, sentence.data(), sentence.size());
  } catch (const std::exception& e) {
    const std::string sentence = std::string("\ncannot be read: ") + e.what();
    sent = write_all(end, &kRefused, 1) && write_all(end, sentence.data(), sentence.size());
  }
  _exit(sent ? 0 : 1);
}

}  // namespace

Result<Bytes> in_isolation(std::size_t input_bytes, const std::function<Result<Bytes>()>& work, double seconds,
                           double wall) {
  using Clock = std::chrono::steady_clock;
  const double allowed =
      (seconds + static_cast<double>(input_bytes) / 4e6) * std::max(limit_factor(), 1.0);  // [s] of processor time
  const double wait = wall > 0.0 ? wall : std::max(kPatience * allowed, kLeastPatience);
  const auto deadline = Clock::now() + std::chrono::milliseconds(static_cast<std::int64_t>(wait * 1e3));
  const std::uint64_t memory = private_bytes() + most(limits::kReaderMemory) + 64 * std::uint64_t{input_bytes};
  int ends[2];
  if (pipe(ends) != 0) return Error{"", std::string("cannot be read: no pipe: ") + std::strerror(errno)};
  const pid_t pid = fork();
  if (pid < 0) {
    close(ends[0]), close(ends[1]);
    return Error{"", std::string("cannot be read: no process: ") + std::strerror(errno)};
  }
  if (pid == 0) {
    close(ends[0]);
    child(ends[1], memory, allowed, work);
  }
  close(ends[1]);

  Bytes answer;
  bool late = false;
  std::vector<std::uint8_t> buffer(1 << 20);
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd ready{ends[0], POLLIN, 0};
    const int polled = left > 0 ? poll(&ready, 1, static_cast<int>(left)) : 0;
    if (polled < 0 && errno == EINTR) continue;
    if (polled <= 0) {
      late = true;
      break;
    }
    const ssize_t got = read(ends[0], buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    answer.insert(answer.end(), buffer.begin(), buffer.begin() + got);
  }
  close(ends[0]);
  if (late) kill(pid, SIGKILL);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  const bool spent = WIFSIGNALED(status) && (WTERMSIG(status) == SIGPROF || WTERMSIG(status) == SIGXCPU);
  if (late || spent) return Error{"", "takes too long to read; the file is damaged, or too large"};
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty())
    return Error{"", "crashed the importer; the file is damaged, export it again"};
  const char verdict = static_cast<char>(answer.front());
  answer.erase(answer.begin());
  if (verdict == kDone) return answer;
  const std::string sentence(answer.begin(), answer.end());
  const std::size_t line = std::min(sentence.find('\n'), sentence.size());
  return Error{sentence.substr(0, line), sentence.substr(std::min(line + 1, sentence.size()))};
}

void append_bytes(Bytes& out, const void* data, std::size_t size) {
  const auto* begin = static_cast<const std::uint8_t*>(data);
  out.insert(out.end(), begin, begin + size);
}

bool Taker::take(void* data, std::size_t size) {
  if (size > bytes_.size()) return false;
  if (size > 0) std::memcpy(data, bytes_.data(), size);
  bytes_ = bytes_.subspan(size);
  return true;
}

}  // namespace pliant
