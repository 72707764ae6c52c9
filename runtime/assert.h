// ASSERT: an assertion that is checked in every build; where it fails, the program stops and names the place. VALIDATE:
// the same for checks that cost more than they guard; compiled only into debug and sanitizer builds. UNREACHABLE: the
// end of a function whose switch has a case for every enumerator; a new one without a case does not compile (-Wswitch).
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
