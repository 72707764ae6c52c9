// Work that splits into equal parts, for loading and preparing; never used inside a touch tick. The parts do not depend
// on the number of threads, so results that depend only on their part agree to the bit.
#pragma once

#include <cstddef>
#include <functional>

namespace pliant {

// Number of threads that parallel_for may use; 0: as many as the machine has. Set once, by the command line.
void set_thread_count(unsigned count);
unsigned thread_count();

// Calls body(begin, end) over [0, count) in runs of `grain`, on several threads; returns when all are done. An
// exception of a body is rethrown here, after the other threads have ended.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace pliant
