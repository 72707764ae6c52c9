// ASSERT: a promise the code makes to itself, checked in every build; a broken one stops the program and names the
// place. VALIDATE: the same for checks that cost more than they guard; compiled only into debug and sanitizer builds.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace pliant {

[[noreturn]] inline void broken_promise(const char* what, const char* file, int line) {
  std::fprintf(stderr, "pliant: internal error: %s:%d: %s\n", file, line, what);
  std::abort();
}

}  // namespace pliant

#define ASSERT(condition) ((condition) ? void(0) : ::pliant::broken_promise(#condition, __FILE__, __LINE__))
#ifdef PLIANT_VALIDATE
#define VALIDATE(condition) ASSERT(condition)
#else
#define VALIDATE(condition) void(0)
#endif
