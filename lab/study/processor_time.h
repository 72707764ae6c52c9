// What a study's costs are measured with: processor time, so that other work on the machine counts little. [ns]
#pragma once

#include <cstdint>
#include <ctime>

namespace pliant {

inline std::uint64_t processor_ns(clockid_t whose = CLOCK_THREAD_CPUTIME_ID) {
  timespec now{};
  clock_gettime(whose, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000u + static_cast<std::uint64_t>(now.tv_nsec);
}

// Of all threads of this program: of work that is shared among them.
inline std::uint64_t process_ns() {
  return processor_ns(CLOCK_PROCESS_CPUTIME_ID);
}

}  // namespace pliant
