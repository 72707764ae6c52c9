#include "lab/console/exit.h"

#include <poll.h>
#include <unistd.h>

#include <climits>
#include <cstdio>
#include <new>

#include "lab/console/progress.h"
#include "runtime/printable.h"

namespace pliant {
namespace {

// A line end at the end says nothing.
std::string trimmed(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

// Names from files may hold anything.
std::string note_line(const std::string& sentence) {
  return std::string(progress_line_stands() ? "\r\x1b[K" : "") + "pliant: note: " + printable(trimmed(sentence)) + '\n';
}

}  // namespace

std::string sentence_of(ExitStatus status, const Error& error) {
  std::string sentence = trimmed(error.message());
  if (sentence.find("; ") != std::string::npos) return sentence;
  if (status == kUsage) return sentence + "; see `pliant --help`";
  // A finding in a level is its own cure to a reader who knows the format; `validate` knows of levels alone.
  const bool in_level = !error.pointer.empty() || error.node >= 0;
  return sentence + (in_level ? "; mend the level: `pliant validate` lists every finding" : "");
}

int fail(ExitStatus status, const Error& error) {
  std::fprintf(stderr, "pliant: error: %s\n", printable(sentence_of(status, error)).c_str());
  return status;
}

Error explain(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error))
    return {"memory", "out of memory; use a coarser mesh, or smaller pictures (--size)"};
  return {"pliant", std::string(error.what()) + "; please report this input"};
}

void note(const std::string& sentence) {
  std::fputs(note_line(sentence).c_str(), stderr);
}

void note_at_once(const std::string& sentence) {
  const std::string line = note_line(sentence);
  pollfd room{STDERR_FILENO, POLLOUT, 0};
  // A pipe that can be written has room for PIPE_BUF bytes, which is more than a line.
  if (line.size() > PIPE_BUF || ::poll(&room, 1, 0) <= 0 || !(room.revents & POLLOUT)) return;
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
}

}  // namespace pliant
