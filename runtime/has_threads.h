// Whether threads can be started. In WebAssembly without -pthread they cannot: lockstep works, real time does not.
#pragma once

namespace pliant {

#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
inline constexpr bool kHasThreads = false;
#else
inline constexpr bool kHasThreads = true;
#endif

}  // namespace pliant
