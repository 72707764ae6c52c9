#include "lab/console/exit.h"

#include <poll.h>
#include <unistd.h>

#include <climits>
#include <cstdio>
#include <new>

#include "content/files/file_io.h"
#include "lab/console/progress.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

// Removes trailing blanks and line ends.
std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

// printable(): a name from a file may contain control characters.
std::string note_line(const std::string& sentence) {
  return std::string(progress_line_stands() ? "\r\x1b[K" : "") + "pliant: note: " + printable(trimmed(sentence)) + '\n';
}

}  // namespace

std::string sentence_of(ExitStatus status, const Error& error) {
  if (!error.cure.empty()) return trimmed(error.message());
  Error cured = error;
  cured.what = trimmed(error.what);
  // An error inside a level file is fixed by editing the level; `pliant validate` reads levels only.
  if (status == kUsage)
    cured.cure = "see `pliant --help`";
  else if (!error.pointer.empty() || error.node >= 0)
    cured.cure = "mend the level: `pliant validate` lists every finding";
  return cured.message();
}

int fail(ExitStatus status, const Error& error) {
  std::fprintf(stderr, "pliant: error: %s\n", printable(sentence_of(status, error)).c_str());
  return error.code == kDiskFull ? kNoRoom : status;
}

Error explain(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error))
    return {"memory", "out of memory", "use a coarser mesh, or smaller pictures (--size)"};
  return {"pliant", std::string(error.what()), "please report this input"};
}

void note(const std::string& sentence) {
  std::fputs(note_line(sentence).c_str(), stderr);
}

void note_at_once(const std::string& sentence) {
  const std::string line = note_line(sentence);
  pollfd room{STDERR_FILENO, POLLOUT, 0};
  // poll() reports a pipe writable only when it has room for PIPE_BUF bytes, more than one line.
  if (line.size() > PIPE_BUF || ::poll(&room, 1, 0) <= 0 || !(room.revents & POLLOUT)) return;
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
}

}  // namespace pliant
