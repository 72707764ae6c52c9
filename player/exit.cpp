#include "player/exit.h"

#include <cstdio>
#include <new>

#include "runtime/printable.h"

namespace pliant {
namespace {

// Names from files may hold anything; a line end at the end says nothing.
std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == ' ' || text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return printable(text);
}

}  // namespace

int fail(ExitStatus status, const Error& error) {
  std::string sentence = one_line(error.message());
  if (sentence.find("; ") == std::string::npos)  // a finding that is its own cure, to a reader who knows the format
    sentence += status == kUsage ? "; see `pliant --help`" : "; mend the input: `pliant validate` lists every finding";
  std::fprintf(stderr, "pliant: error: %s\n", sentence.c_str());
  return status;
}

Error explain(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error))
    return {"memory", "there is not enough for this input; use a smaller one"};
  return {"pliant", std::string(error.what()) + "; please report this input"};
}

void note(const std::string& sentence) {
  std::fprintf(stderr, "pliant: note: %s\n", one_line(sentence).c_str());
}

}  // namespace pliant
