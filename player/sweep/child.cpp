#include "player/sweep/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

namespace pliant {
namespace fs = std::filesystem;
namespace {

constexpr const char* kSaid = "stderr.txt";
constexpr std::string_view kError = "pliant: error: ";
constexpr std::size_t kLongestSaid = 2000;  // [byte] of a sentence in a line

}  // namespace

Result<Child> Child::start(const std::vector<std::string>& arguments, const fs::path& folder, double timeout) {
  Child child;
  child.folder_ = folder;
  child.timeout_ = timeout;
  std::vector<std::string> words{"pliant"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, kSaid, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  // A group of its own: Ctrl-C is for the sweep, which ends its runs itself.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  child.begun_ = Clock::now();
  const int error = posix_spawn(&child.process_, "/proc/self/exe", &files, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (error != 0) {
    child.process_ = -1;
    return Error{"run", std::string("cannot be started: ") + std::strerror(error) +
                            "; end other programs, or take a "
                            "lower --jobs"};
  }
  return child;
}

Child::Child(Child&& other) noexcept {
  *this = std::move(other);
}

Child& Child::operator=(Child&& other) noexcept {
  end();
  process_ = std::exchange(other.process_, -1);
  status_ = other.status_;
  timed_out_ = other.timed_out_;
  timeout_ = other.timeout_;
  seconds_ = other.seconds_;
  begun_ = other.begun_;
  folder_ = std::move(other.folder_);
  return *this;
}

Child::~Child() {
  end();
}

// With all that it has started (the importers' processes).
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
  if (::waitpid(process_, &status_, WNOHANG) == process_) {
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
  if (timed_out_ || !WIFEXITED(status_)) return {};
  return WEXITSTATUS(status_);
}

std::string Child::complaint() const {
  if (timed_out_) return fmt::format("was not done after {:g} s; raise timeout_s in the plan", timeout_);
  if (WIFSIGNALED(status_))
    return fmt::format("ended by signal {} ({}); try it with `pliant run`", WTERMSIG(status_),
                       ::strsignal(WTERMSIG(status_)));
  std::ifstream in(folder_ / kSaid);
  std::string said;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(kError)) said = line.substr(kError.size(), kLongestSaid);
  return said.empty() ? fmt::format("ended with status {} and said nothing; try it with `pliant run`",
                                    WIFEXITED(status_) ? WEXITSTATUS(status_) : -1)
                      : said;
}

}  // namespace pliant
