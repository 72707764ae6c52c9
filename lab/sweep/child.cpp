#include "lab/sweep/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <utility>

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kError = "pliant: error: ";
constexpr std::size_t kLongestSaid = 2000;  // [byte] longest message in a line
constexpr std::size_t kMostRead = 1 << 20;  // [byte] last part of its stderr that is kept

// Runs in the new process before exec: system calls only. An error is written to `errors`.
[[noreturn]] void become(char* const* argv, const char* from, int said, pid_t parent, int errors) {
  // Ends with the parent, however that ends: SIGKILL of a sweep leaves no process behind.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  // A separate process group: Ctrl-C reaches the sweep only, which ends its runs itself.
  ::setpgid(0, 0);
  const int in = ::open("/dev/null", O_RDONLY), out = ::open("/dev/null", O_WRONLY);
  if (in >= 0 && out >= 0 && ::dup2(in, STDIN_FILENO) >= 0 && ::dup2(out, STDOUT_FILENO) >= 0 &&
      ::dup2(said, STDERR_FILENO) >= 0 && ::chdir(from) == 0) {
    for (const int file : {in, out})
      if (file > STDERR_FILENO) ::close(file);
    ::execv("/proc/self/exe", argv);
  }
  const int why = errno;
  [[maybe_unused]] const ssize_t ignored = ::write(errors, &why, sizeof why);
  ::_exit(1);
}

}  // namespace

Result<Child> Child::start(const std::vector<std::string>& arguments, const fs::path& from, const fs::path& folder,
                           double timeout) {
  Child child;
  child.folder_ = folder;
  child.timeout_ = timeout;
  std::vector<std::string> words{"pliant"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const auto not_started = [](int error) {
    return Error{"run", std::string("cannot be started: ") + std::strerror(error),
                 "end other programs, or take a lower --jobs"};
  };

  child.said_ = ::memfd_create("pliant-said", MFD_CLOEXEC);
  if (child.said_ < 0) return not_started(errno);
  int ends[2];  // closed by a successful exec
  if (::pipe2(ends, O_CLOEXEC) != 0) return not_started(errno);
  child.begun_ = Clock::now();
  const pid_t parent = ::getpid();
  child.process_ = ::fork();
  if (child.process_ == 0) become(argv.data(), from.c_str(), child.said_, parent, ends[1]);
  const int forked = errno;
  ::close(ends[1]);
  int why = child.process_ < 0 ? forked : 0;
  if (child.process_ > 0)
    while (::read(ends[0], &why, sizeof why) < 0 && errno == EINTR) {
    }
  ::close(ends[0]);
  if (why != 0) return not_started(why);
  return child;
}

Child::Child(Child&& other) noexcept {
  *this = std::move(other);
}

Child& Child::operator=(Child&& other) noexcept {
  end();
  if (said_ >= 0) ::close(said_);
  process_ = std::exchange(other.process_, -1);
  said_ = std::exchange(other.said_, -1);
  status_ = other.status_;
  timed_out_ = other.timed_out_;
  lost_ = other.lost_;
  timeout_ = other.timeout_;
  seconds_ = other.seconds_;
  begun_ = other.begun_;
  folder_ = std::move(other.folder_);
  return *this;
}

Child::~Child() {
  end();
  if (said_ >= 0) ::close(said_);
}

// Kills the whole group, with the importer processes that it has started.
void Child::end() {
  if (process_ < 0) return;
  ::kill(-process_, SIGKILL);
  while (::waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
}

bool Child::is_over() {
  if (process_ < 0) return true;
  const double elapsed = std::chrono::duration<double>(Clock::now() - begun_).count();
  const pid_t waited = ::waitpid(process_, &status_, WNOHANG);
  if (waited == process_ || (waited < 0 && errno != EINTR)) {
    lost_ = waited < 0;
    process_ = -1;
    seconds_ = elapsed;
    return true;
  }
  if (timeout_ <= 0.0 || elapsed < timeout_) return false;
  timed_out_ = true;
  end();
  seconds_ = elapsed;
  return true;
}

std::optional<int> Child::exit_status() const {
  if (timed_out_ || lost_ || !WIFEXITED(status_)) return {};
  return WEXITSTATUS(status_);
}

std::string Child::complaint() const {
  if (timed_out_) return fmt::format("was not done after {:g} s; raise timeout_s in the plan", timeout_);
  if (lost_) return "ended, but the system did not say how; begin the sweep with SIGCHLD as usual, and try again";
  if (WIFSIGNALED(status_))
    return fmt::format("ended by signal {} ({}); try it with `pliant run`", WTERMSIG(status_),
                       ::strsignal(WTERMSIG(status_)));
  const off_t size = ::lseek(said_, 0, SEEK_END);
  std::string all(std::min<std::size_t>(size > 0 ? static_cast<std::size_t>(size) : 0, kMostRead), '\0');
  const ssize_t got = ::pread(said_, all.data(), all.size(), size - static_cast<off_t>(all.size()));
  all.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  std::istringstream in(all);
  std::string said;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(kError)) said = line.substr(kError.size(), kLongestSaid);
  return said.empty() ? fmt::format("ended with status {} and said nothing; try it with `pliant run`",
                                    WIFEXITED(status_) ? WEXITSTATUS(status_) : -1)
                      : said;
}

}  // namespace pliant
