// Independent tasks of one soft step on threads that wait between the steps: starting threads takes longer than many of
// these tasks. For the soft clock, never inside a touch tick. Tasks do not depend on the number of threads, so results
// that depend only on their task agree to the bit.
#pragma once

#include <cstddef>
#include <type_traits>

namespace pliant {

inline constexpr unsigned kMostTaskThreads = 8;  // the caller's among them; more do not pay for one body's systems

namespace detail {
struct TaskCall {
  void (*call)(const void* task, std::size_t i, unsigned thread);
  const void* task;
};
void run_tasks(std::size_t count, TaskCall call);
}  // namespace detail

// Calls task(i, thread) for each i < count, on at most thread_count() threads (parallel.h); returns when all are done.
// thread < kMostTaskThreads numbers the threads of this call, for their scratch memory. Tasks begin in ascending order.
// Inside a task, or while another thread runs tasks, all are done by the calling thread. An exception of a task is
// rethrown here, after the other threads have ended.
template <class Task>
void run_tasks(std::size_t count, const Task& task) {
  detail::run_tasks(
      count, {[](const void* t, std::size_t i, unsigned thread) { (*static_cast<const Task*>(t))(i, thread); }, &task});
}

}  // namespace pliant
