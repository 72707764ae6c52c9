// CPU time [ns], the cost measure of studies: other work on the machine has little influence on it.
#pragma once

#include <cstdint>
#include <ctime>

#include "runtime/helped_time.h"

namespace pliant {

// Of this thread, with what others spent on its tasks; or of all threads.
inline std::uint64_t processor_ns(clockid_t whose = CLOCK_THREAD_CPUTIME_ID) {
  timespec now{};
  clock_gettime(whose, &now);
  const std::uint64_t helped = whose == CLOCK_THREAD_CPUTIME_ID ? helped_ns() : 0;
  return helped + static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000u + static_cast<std::uint64_t>(now.tv_nsec);
}

// CPU time of all threads of the process, for work shared among them.
inline std::uint64_t process_ns() {
  return processor_ns(CLOCK_PROCESS_CPUTIME_ID);
}

}  // namespace pliant
