#include "lab/console/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>

namespace pliant {

void prepare_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    // open() returns the lowest free number: this stream's, since those before it are open.
    if (::fcntl(stream, F_GETFD) == -1 && errno == EBADF && ::open("/dev/null", O_RDWR) != stream) ::_exit(1);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGCHLD, SIG_DFL);  // the parent may have ignored it; waiting for a process would then fail
}

std::optional<Error> close_stdout() {
  const bool lost = std::ferror(stdout) != 0;
  errno = 0;
  if (std::fflush(stdout) == 0 && !lost) return {};
  const std::string why = errno != 0 ? ": " + std::generic_category().message(errno) : std::string();
  return Error{"stdout", "cannot be written" + why,
               "free some space, or keep the reading program open (files were written)"};
}

}  // namespace pliant
