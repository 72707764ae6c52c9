// Every tick's readings, as a host takes them.
#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

TEST(SessionReadings, EveryTickOfALockstepRunIsThereOnceAndInOrder) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.keep_readings(64));
  std::vector<Reading> some;
  std::uint64_t next = 0;
  for (double y = 0.0005; y > -0.003; y -= 1e-5) {
    ASSERT_TRUE(session.move("finger", {0, y, 0}));
    ASSERT_TRUE(session.step(7));
    const auto lost = session.take_readings("finger", some);
    ASSERT_TRUE(lost) << lost.error().message();
    EXPECT_EQ(*lost, 0u);
    ASSERT_EQ(some.size(), 7u);
    for (const Reading& reading : some) EXPECT_EQ(reading.tick, next++);
    EXPECT_EQ(some.back().force, session.reading("finger")->force);
  }
  EXPECT_TRUE(some.back().touching);
  EXPECT_NE(some.back().contact[0].triangle, ContactSide::kNone);
}

TEST(SessionReadings, WhatFindsNoRoomIsCounted) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.keep_readings(64));
  ASSERT_TRUE(session.step(100));
  std::vector<Reading> some;
  EXPECT_EQ(*session.take_readings("finger", some), 36u);
  EXPECT_EQ(some.size(), 64u);
  ASSERT_TRUE(session.step(10));
  EXPECT_EQ(*session.take_readings("finger", some), 0u);
  ASSERT_EQ(some.size(), 10u);
  EXPECT_EQ(some.front().tick, 100u);
}

TEST(SessionReadings, AreRefusedInASentence) {
  Session session = opened(press_scene());
  std::vector<Reading> some;
  EXPECT_FALSE(session.take_readings("finger", some));
  EXPECT_FALSE(session.keep_readings(std::size_t{1} << 50));
  ASSERT_TRUE(session.keep_readings(8));
  EXPECT_FALSE(session.take_readings("thumb", some));
  ASSERT_TRUE(session.restart());
  ASSERT_TRUE(session.step(3));
  EXPECT_EQ(*session.take_readings("finger", some), 0u);
  EXPECT_EQ(some.size(), 3u) << "they are kept beyond a restart";
  ASSERT_TRUE(session.keep_readings(0));
  EXPECT_FALSE(session.take_readings("finger", some));
}

TEST(SessionReadings, RealTimeShowsAllTicksToAHostThatLooksTwentyTimesASecond) {
  Session session = opened(press_scene());
  ASSERT_TRUE(session.keep_readings(4096));
  ASSERT_TRUE(session.move("finger", {0, 0.01, 0}));
  ASSERT_TRUE(session.start());
  EXPECT_FALSE(session.keep_readings(1)) << "not while the clocks run";
  std::vector<Reading> all, some;
  std::uint64_t lost = 0;
  ASSERT_TRUE(within_five_seconds([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    lost += *session.take_readings("finger", some);
    all.insert(all.end(), some.begin(), some.end());
    return all.size() > 300;
  }));
  ASSERT_TRUE(session.stop());
  lost += *session.take_readings("finger", some);
  all.insert(all.end(), some.begin(), some.end());
  EXPECT_EQ(lost, 0u);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_GT(all[i].tick, all[i - 1].tick);
  if (session.figures().overruns == 0) EXPECT_EQ(all.size(), all.back().tick + 1);
  EXPECT_EQ(all.back().force, dvec3(0)) << "the last force is zero";
}

}  // namespace
}  // namespace pliant
