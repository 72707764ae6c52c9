#include "runtime/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "runtime/has_threads.h"
#include "runtime/long_work.h"

namespace pliant {
namespace {
std::atomic<unsigned> g_thread_count{0};
}

void set_thread_count(unsigned count) {
  g_thread_count = count;
}

unsigned thread_count() {
  if (!kHasThreads) return 1;
  const unsigned wanted = g_thread_count;
  return wanted ? wanted : std::max(1u, std::thread::hardware_concurrency());
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  grain = std::max<std::size_t>(grain, 1);
  const std::size_t runs = (count + grain - 1) / grain;
  std::atomic<std::size_t> next{0};
  std::exception_ptr thrown;
  std::mutex mutex;  // guards `thrown`
  const auto work = [&] {
    try {
      for (std::size_t run = next++; run < runs; run = next++) {
        body(run * grain, std::min(count, (run + 1) * grain));
        check_in();  // only the calling thread is watched
      }
    } catch (...) {
      next = runs;  // the other threads stop after their current part
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
    }
  };
  const std::size_t helpers = std::min<std::size_t>(thread_count(), runs) - 1;
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < helpers; ++i) threads.emplace_back(work);
    work();
  }
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace pliant
