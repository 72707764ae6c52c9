// pliant_generate FOLDER: generates everything that ships under content/. Run by hand; the output is committed.
#include <cstdio>
#include <string_view>

#include "content/generate/levels.h"

int main(int argc, char** argv) {
  const std::string_view folder = argc == 2 ? argv[1] : "";
  const bool asked = folder == "--help" || folder == "-h";
  if (folder.empty() || folder.front() == '-') {
    std::fprintf(asked ? stdout : stderr, "usage: pliant_generate FOLDER\nexample: pliant_generate content\n");
    return asked ? 0 : 2;
  }
  const pliant::Status done = pliant::generate::generate(argv[1]);
  if (!done) std::fprintf(stderr, "pliant: error: %s\n", done.error().message().c_str());
  return done.ok() ? 0 : 1;
}
