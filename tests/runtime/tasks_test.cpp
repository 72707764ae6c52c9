#include "runtime/tasks.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "runtime/parallel.h"

namespace pliant {
namespace {

TEST(Tasks, RunEachOnceForEveryNumberOfThreads) {
  for (const unsigned threads : {1u, 2u, 4u, 20u}) {
    set_thread_count(threads);
    for (const std::size_t count : {0u, 1u, 2u, 7u, 1000u})
      for (int again = 0; again < 20; ++again) {
        std::vector<std::atomic<int>> visits(count);
        std::atomic<unsigned> highest{0};
        run_tasks(count, [&](std::size_t i, unsigned thread) {
          ++visits[i];
          for (unsigned seen = highest; thread > seen && !highest.compare_exchange_weak(seen, thread);) {
          }
        });
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(visits[i], 1) << i << " of " << count;
        EXPECT_LT(highest, std::min(threads, kMostTaskThreads));
      }
  }
  set_thread_count(0);
}

// Two tasks of one call never have the same thread number at once: it stands for scratch memory.
TEST(Tasks, ShareNoThreadNumberAtOnce) {
  set_thread_count(4);
  std::vector<std::atomic<int>> inside(kMostTaskThreads);
  std::atomic<bool> alone{true};
  run_tasks(200, [&](std::size_t, unsigned thread) {
    if (++inside[thread] != 1) alone = false;
    std::this_thread::yield();
    --inside[thread];
  });
  EXPECT_TRUE(alone);
  set_thread_count(0);
}

TEST(Tasks, MayBeRunInsideATaskAndByManyThreads) {
  set_thread_count(3);
  std::atomic<int> done{0};
  std::vector<std::jthread> callers;
  for (int caller = 0; caller < 3; ++caller)
    callers.emplace_back([&] {
      for (int again = 0; again < 50; ++again)
        run_tasks(5, [&](std::size_t, unsigned) { run_tasks(4, [&](std::size_t, unsigned) { ++done; }); });
    });
  callers.clear();
  EXPECT_EQ(done, 3 * 50 * 5 * 4);
  set_thread_count(0);
}

TEST(Tasks, ThrowHereWhatATaskThrows) {
  for (const unsigned threads : {1u, 4u}) {
    set_thread_count(threads);
    const auto task = [](std::size_t i, unsigned) {
      if (i >= 32) throw std::runtime_error("no more");
    };
    EXPECT_THROW(run_tasks(64, task), std::runtime_error) << threads;
    std::atomic<int> after{0};
    run_tasks(8, [&](std::size_t, unsigned) { ++after; });
    EXPECT_EQ(after, 8);
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace pliant
