// What a study's costs are measured with: processor time of one thread, so that other work on the machine counts
// little. [ns]
#pragma once

#include <cstdint>
#include <ctime>

namespace pliant {

inline std::uint64_t processor_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000u + static_cast<std::uint64_t>(now.tv_nsec);
}

}  // namespace pliant
