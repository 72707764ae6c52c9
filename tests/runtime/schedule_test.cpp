#include "runtime/schedule.h"

#include <gtest/gtest.h>

#include <string>

namespace pliant {
namespace {

struct Log {
  std::string order;
  std::vector<std::uint64_t> ticks;
};

std::vector<System<Log>> three_systems() {
  return {{"first", [](Log& log, Tick) { log.order += 'a'; }},
          {"second", [](Log& log, Tick tick) { log.ticks.push_back(tick.index); }},
          {"third", [](Log& log, Tick) { log.order += 'c'; }}};
}

TEST(Schedule, RunsItsSystemsInTheOrderOfTheListAndCountsEveryRun) {
  Log log;
  Schedule<Log> schedule(three_systems());
  LockstepClock clock(500.0);
  for (int i = 0; i < 4; ++i) schedule.run(log, clock.next());
  EXPECT_EQ(log.order, "acacacac");
  EXPECT_EQ(log.ticks, (std::vector<std::uint64_t>{0, 1, 2, 3}));
  ASSERT_EQ(schedule.systems().size(), 3u);
  EXPECT_EQ(schedule.systems()[1].name, "second");
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(schedule.cost(i).count(), 4u);
  EXPECT_EQ(schedule.total().count(), 4u);
}

TEST(Schedule, TotalIsTheSumOfItsSystems) {
  Log log;
  Schedule<Log> schedule(three_systems());
  schedule.run(log, Tick{});
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) sum += schedule.cost(i).max_us();
  EXPECT_NEAR(schedule.total().max_us(), sum, 1e-9);
}

TEST(LockstepClock, CountsVirtualTimeWhateverTheMachineDoes) {
  LockstepClock clock(1000.0);
  for (std::uint64_t i = 0; i < 100000; ++i) {
    const Tick tick = clock.next();
    ASSERT_EQ(tick.index, i);
    ASSERT_EQ(tick.dt, 1e-3);
    ASSERT_EQ(tick.time, static_cast<double>(i) * 1e-3) << "time is a product, so that it does not drift";
  }
}

TEST(RealtimeClock, NeverGoesBackAndSkipsWhatItMissed) {
  RealtimeClock clock(1000.0);
  Tick last = clock.next();
  EXPECT_EQ(last.index, 0u);
  std::uint64_t asked = 1;
  for (int i = 0; i < 20; ++i, ++asked) {
    const Tick tick = clock.next();
    ASSERT_GT(tick.index, last.index);
    last = tick;
  }
  const std::uint64_t begin = now_ns();
  while (now_ns() - begin < 20'000'000) {
  }  // a tick of 20 ms: at least 18 periods are missed
  const Tick late = clock.next();
  ++asked;
  EXPECT_GE(late.index, last.index + 19);
  EXPECT_NEAR(late.elapsed(), late.time - last.time, 1e-9);
  EXPECT_EQ(last.elapsed() > last.dt, last.skipped > 0);
  EXPECT_EQ(late.index + 1, asked + clock.overruns()) << "every index was handed out or counted as an overrun";
}

// 1e9 / 3000 is not an integer: truncated to nanoseconds, a second of ticks would be 1 us short.
TEST(RealtimeClock, HasTheTimesOfTheLockstepClockAtEveryRate) {
  for (const double rate : {1000.0, 1024.0, 3000.0, 100000.0 / 7.0}) {
    RealtimeClock clock(rate);
    for (int i = 0; i < 10; ++i) {
      const Tick tick = clock.next();
      ASSERT_EQ(tick.dt, 1.0 / rate);
      ASSERT_EQ(tick.time, static_cast<double>(tick.index) * (1.0 / rate));
    }
  }
}

}  // namespace
}  // namespace pliant
