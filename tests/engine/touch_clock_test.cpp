// The touch clock in real time: a pause and a failure are seen in the rows, as zero force.
#include "engine/run/touch_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <thread>

#include "scenes/scenes.h"
#include "systems/schedule.h"

namespace pliant {
namespace {

struct Row {
  std::uint64_t tick = 0;
  double force = 0.0;  // [N] upwards
  bool ready = false;
};

// A probe that moves 2 mm deep within 0.2 s and stays there.
class RealTouchClock : public ::testing::Test {
 protected:
  void SetUp() override {
    stage_.add(scenes::sheet(20, 0.1), {});
    probe_ = stage_.add_probe({0, 0.002, 0});
    stage_.prepare();
    rows_.reserve(1 << 16);
    hooks_.before = [this](Tick tick) {
      HapticDevice& device = stage_.device(probe_);
      device.position = {0, std::max(-0.002, 0.002 - 0.02 * tick.time), 0};
      device.sensed_at = tick.time;
    };
    hooks_.after = [this](Tick tick) {
      const HapticDevice& device = stage_.device(probe_);
      rows_.push_back({tick.index, device.force_sent.y, device.status == DeviceStatus::kReady});
    };
    hooks_.idle = [this](Tick) { idle_ = true; };
  }
  static bool within_twenty_seconds(const std::function<bool()>& true_by_then) {
    for (int i = 0; i < 10000; ++i) {
      if (true_by_then()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }

  scenes::Stage stage_;
  Entity probe_;
  TouchHooks hooks_;
  std::vector<Row> rows_;  // the clock's until it is done
  std::atomic<bool> idle_{false};
};

TEST_F(RealTouchClock, APauseIsOneRowOfALostDeviceWithZeroForce) {
  Schedule<World> schedule(touch_schedule());
  TouchClock touch(stage_.world, schedule, nullptr, 1000.0, 1 << 15, hooks_);
  touch.start();
  ASSERT_TRUE(within_twenty_seconds([&] { return touch.now() > 400; }));
  touch.pause(true);
  ASSERT_TRUE(within_twenty_seconds([&] { return idle_.load(); }));
  const std::uint64_t stood = touch.now();
  touch.pause(false);
  ASSERT_TRUE(within_twenty_seconds([&] { return touch.now() > stood + 50; }));
  touch.stop();
  ASSERT_FALSE(touch.error());
  std::vector<std::size_t> lost;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (i > 0) ASSERT_GT(rows_[i].tick, rows_[i - 1].tick);
    if (!rows_[i].ready) lost.push_back(i);
  }
  ASSERT_EQ(lost.size(), 2u) << "the pause and the end";
  EXPECT_EQ(lost[1], rows_.size() - 1);
  EXPECT_GT(rows_[lost[0] - 1].force, 0.0) << "it hardly pressed";
  for (std::size_t i = lost[0]; i < rows_.size(); ++i)
    EXPECT_EQ(rows_[i].force, 0.0) << "the gate is closed, row " << i;
  EXPECT_EQ(rows_[lost[0]].tick, stood);
}

TEST_F(RealTouchClock, AnExceptionLeavesARowOfZeroForce) {
  std::vector<System<World>> systems = touch_schedule();
  systems.push_back({"fails", [](World&, Tick tick) {
                       if (tick.index >= 400) throw std::runtime_error("cable cut");
                     }});
  Schedule<World> schedule(systems);
  TouchClock touch(stage_.world, schedule, nullptr, 1000.0, 1 << 15, hooks_);
  touch.start();
  ASSERT_TRUE(within_twenty_seconds([&] { return touch.done(); }));
  touch.stop();
  ASSERT_TRUE(touch.error());
  EXPECT_NE(touch.error()->message().find("cable cut"), std::string::npos);
  ASSERT_GT(rows_.size(), 2u);
  EXPECT_GT(rows_[rows_.size() - 2].force, 0.0);
  EXPECT_EQ(rows_.back().force, 0.0);
  EXPECT_FALSE(rows_.back().ready);
  EXPECT_EQ(touch.now(), rows_.back().tick);
}

TEST_F(RealTouchClock, AnExceptionInTheFirstTickLeavesNoRow) {
  std::vector<System<World>> systems = touch_schedule();
  systems.push_back({"fails", [](World&, Tick) { throw std::runtime_error("cable cut"); }});
  Schedule<World> schedule(systems);
  TouchClock touch(stage_.world, schedule, nullptr, 1000.0, 1 << 15, hooks_);
  touch.start();
  ASSERT_TRUE(within_twenty_seconds([&] { return touch.done(); }));
  touch.stop();
  EXPECT_TRUE(touch.error());
  EXPECT_TRUE(rows_.empty());
}

}  // namespace
}  // namespace pliant
