#include "runtime/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace pliant {
namespace {

TEST(ParallelFor, CoversEachIndexOnceForEveryThreadCount) {
  for (unsigned threads : {1u, 2u, 3u, 4u}) {
    set_thread_count(threads);
    EXPECT_EQ(thread_count(), threads);
    for (std::size_t count : {0u, 1u, 7u, 1000u, 4097u}) {
      for (std::size_t grain : {0u, 1u, 64u, 5000u}) {
        std::vector<std::atomic<int>> visits(count);
        parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) ++visits[i];
        });
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(visits[i], 1) << i << " of " << count << ", grain " << grain;
      }
    }
  }
  set_thread_count(0);
  EXPECT_GE(thread_count(), 1u);
}

TEST(ParallelFor, CutsTheSamePartsWhateverTheThreadCount) {
  const auto parts = [](unsigned threads) {
    set_thread_count(threads);
    std::mutex mutex;
    std::set<std::pair<std::size_t, std::size_t>> cut;
    parallel_for(1000, 128, [&](std::size_t begin, std::size_t end) {
      const std::lock_guard lock(mutex);
      cut.insert({begin, end});
    });
    return cut;
  };
  const auto alone = parts(1);
  EXPECT_EQ(alone.size(), 8u);
  EXPECT_EQ(parts(4), alone);
  set_thread_count(0);
}

TEST(ParallelFor, ThrowsHereWhatABodyThrows) {
  for (const unsigned threads : {1u, 4u}) {
    set_thread_count(threads);
    const auto body = [](std::size_t begin, std::size_t) {
      if (begin >= 32) throw std::runtime_error("no more");
    };
    EXPECT_THROW(parallel_for(64, 1, body), std::runtime_error) << threads;
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace pliant
