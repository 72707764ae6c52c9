// ASSERT checks in every build. On failure the program stops and prints the place. VALIDATE is for expensive checks; it
// is compiled only into debug and sanitizer builds. UNREACHABLE marks the end of a function whose switch has a case for
// every enumerator; a new enumerator without a case does not compile (-Wswitch).
#pragma once

#include <cstdio>
#include <cstdlib>

namespace pliant {

[[noreturn]] void assertion_failed(const char* what, const char* file, int line);

}  // namespace pliant

#define ASSERT(condition) ((condition) ? void(0) : ::pliant::assertion_failed(#condition, __FILE__, __LINE__))
#define UNREACHABLE() ::pliant::assertion_failed("no case for this value", __FILE__, __LINE__)
#ifdef PLIANT_VALIDATE
#define VALIDATE(condition) ASSERT(condition)
#else
#define VALIDATE(condition) void(0)
#endif
