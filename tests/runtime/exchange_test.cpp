// Data exchanged between two threads arrives complete, in order, and newest first. Also built with the thread
// sanitizer.
#include "runtime/exchange.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "runtime/recorder.h"

namespace pliant {
namespace {

// A state that reveals tearing: every word has the same value.
struct State {
  std::array<std::uint64_t, 64> words{};
};

TEST(TripleBuffer, ReaderSeesWholeStatesThatOnlyGetNewer) {
  constexpr std::uint64_t kLast = 20000;
  TripleBuffer<State> buffer;
  std::jthread writer([&] {
    for (std::uint64_t n = 1; n <= kLast; ++n) {
      buffer.write().words.fill(n);
      (void)buffer.publish();
      if (n % 64 == 0) std::this_thread::yield();
    }
  });
  std::uint64_t newest = 0, taken = 0;
  while (newest < kLast) {
    if (!buffer.acquire()) {
      std::this_thread::yield();
      continue;
    }
    ++taken;
    const std::uint64_t first = buffer.read().words.front();
    for (std::uint64_t word : buffer.read().words) ASSERT_EQ(word, first) << "torn";
    ASSERT_GT(first, newest);
    newest = first;
  }
  EXPECT_FALSE(buffer.acquire()) << "the newest state is handed out once";
  EXPECT_GE(taken, 1u);
}

TEST(TripleBuffer, PublishSaysWhetherTheStateBeforeWasSeen) {
  TripleBuffer<int> buffer(5);
  EXPECT_EQ(buffer.read(), 5);
  buffer.write() = 1;
  EXPECT_TRUE(buffer.publish()) << "nothing waited";
  buffer.write() = 2;
  EXPECT_FALSE(buffer.publish()) << "1 was replaced unseen";
  ASSERT_TRUE(buffer.acquire());
  EXPECT_EQ(buffer.read(), 2);
  buffer.write() = 3;
  EXPECT_TRUE(buffer.publish());
}

TEST(Ring, HandsOverEveryItemInOrderBetweenTwoThreads) {
  constexpr std::uint64_t kCount = 50000;
  Ring<std::uint64_t> ring(100);
  std::jthread writer([&] {
    for (std::uint64_t n = 0; n < kCount;) {
      if (ring.push(n))
        ++n;
      else
        std::this_thread::yield();
    }
  });
  for (std::uint64_t expected = 0, got = 0; expected < kCount;) {
    if (!ring.pop(got)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(got, expected++);
  }
  std::uint64_t left = 0;
  EXPECT_FALSE(ring.pop(left));
}

TEST(Ring, RefusesWhenFullAndTakesAgainWhenOneWasRead) {
  Ring<int> ring(3);
  ASSERT_EQ(ring.capacity(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(4));
  int item = -1;
  ASSERT_TRUE(ring.pop(item));
  EXPECT_EQ(item, 0);
  EXPECT_TRUE(ring.push(4));
  for (int expected = 1; expected <= 4; ++expected) {
    ASSERT_TRUE(ring.pop(item));
    EXPECT_EQ(item, expected);
  }
  EXPECT_FALSE(ring.pop(item));
}

TEST(Recorder, KeepsRowsInOrderAndCountsTheOnesItHadNoRoomFor) {
  Recorder<int> recorder(4);
  for (int i = 0; i < 7; ++i) recorder.record(i);
  std::vector<int> rows{-1};
  recorder.drain(rows);
  EXPECT_EQ(rows, (std::vector<int>{-1, 0, 1, 2, 3}));
  EXPECT_EQ(recorder.lost(), 3u);
  recorder.record(9);
  recorder.drain(rows);
  EXPECT_EQ(rows.back(), 9);
  EXPECT_EQ(recorder.lost(), 3u);
}

TEST(Recorder, EveryRowIsEitherKeptOrCountedWhileTwoThreadsWork) {
  constexpr std::uint64_t kCount = 30000;
  Recorder<std::uint64_t> recorder(256);
  std::atomic<bool> done{false};
  std::jthread writer([&] {
    for (std::uint64_t n = 0; n < kCount; ++n) recorder.record(n);
    done = true;
  });
  std::vector<std::uint64_t> rows;
  while (!done) recorder.drain(rows);
  recorder.drain(rows);
  EXPECT_EQ(rows.size() + recorder.lost(), kCount);
  for (std::size_t i = 1; i < rows.size(); ++i) ASSERT_LT(rows[i - 1], rows[i]);
}

}  // namespace
}  // namespace pliant
