#include "player/exit.h"

#include <cstdio>

namespace pliant {
namespace {

// Names from files may hold anything: what would break the line becomes a space.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

}  // namespace

int fail(ExitStatus status, const Error& error) {
  std::fprintf(stderr, "pliant: error: %s\n", one_line(error.message()).c_str());
  return status;
}

void note(const std::string& sentence) { std::fprintf(stderr, "pliant: note: %s\n", one_line(sentence).c_str()); }

}  // namespace pliant
