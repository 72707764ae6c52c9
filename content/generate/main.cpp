// pliant_generate FOLDER: makes everything that ships under content/. Run by hand; the output is committed.
#include <cstdio>

#include "content/generate/levels.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: pliant_generate FOLDER\nexample: pliant_generate content\n");
    return 2;
  }
  const pliant::Status done = pliant::generate::generate(argv[1]);
  if (!done) std::fprintf(stderr, "pliant: error: %s\n", done.error().message().c_str());
  return done.ok() ? 0 : 1;
}
