#include "systems/device/mouse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/scenes.h"
#include "systems/safety/safety.h"
#include "systems/schedule.h"

namespace pliant {
namespace {

using scenes::Stage;

// A ball, a probe moved by a mouse, and a touch clock with given time.
struct MouseScene {
  Stage stage;
  Entity probe;
  Schedule<World> schedule{touch_schedule()};
  std::uint64_t n = 0;
  MouseScene() {
    stage.add(scenes::sphere(20, 0.1), {{.reach = 0.03}});
    probe = stage.add_probe({0, 0.2, 0});
    stage.device(probe).driver = DriverKind::kMouse;
    add_mouse(stage.world, {0, 0.2, 0});
    stage.prepare();
  }
  void say(dvec3 position, bool free) {
    stage.world.mouse->samples.write() = {position, free};
    stage.world.mouse->samples.publish();
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i, ++n) schedule.run(stage.world, {n, 1e-3, static_cast<double>(n) * 1e-3});
  }
};

TEST(Mouse, HoveringToTheOtherSideOfABodyDoesNotTouchItOnTheWay) {
  MouseScene s;
  s.say({0, 0.12, 0}, true);
  s.run(16);
  s.say({0, -0.12, 0}, true);  // the straight motion would pass through the middle
  s.run(16);
  EXPECT_FALSE(s.stage.read(s.probe).in_contact);
  EXPECT_EQ(s.stage.read(s.probe).force, dvec3(0));
  EXPECT_NEAR(s.stage.read(s.probe).position.y, -0.12, 1e-12);
}

TEST(Mouse, WhatAScriptLeadsIsTakenOverWhereItIsAndNotBefore) {
  MouseScene s;
  HapticDevice& device = s.stage.device(s.probe);
  device.driver = DriverKind::kScript;
  device.status = DeviceStatus::kReady;
  device.path = s.stage.world.paths.add({{{0, {0, 0.2, 0}}, {1, {0.1, 0.2, 0}}}, false, false});
  for (int frame = 0; frame < 10; ++frame) {
    s.say({0, 0.3, 0}, false);
    s.run(16);
  }
  EXPECT_NEAR(device.position.x, 0.0159, 1e-9) << "the script leads it on";
  EXPECT_EQ(device.position.y, 0.2);
  dvec3 before = device.position;
  for (int frame = 0; frame < 10; ++frame) {
    s.stage.world.mouse->samples.write() = {{0.02, 0.2, 0}, false, s.stage.world.registry.get<Probe>(s.probe).device};
    s.stage.world.mouse->samples.publish();
    for (int i = 0; i < 16; ++i) {
      s.run(1);
      EXPECT_LT(length(device.position - before), 1e-3) << "it jumps";
      before = device.position;
    }
  }
  EXPECT_EQ(device.driver, DriverKind::kMouse);
  EXPECT_LT(length(device.position - dvec3(0.02, 0.2, 0)), 1e-9) << "it does not follow the mouse";
}

TEST(Mouse, APressTravelsBetweenFramesAndIsFelt) {
  MouseScene s;
  s.say({0, 0.102, 0}, true);
  s.run(16);
  for (int frame = 1; frame <= 12; ++frame) {
    s.say({0, 0.102 - 0.0005 * frame, 0}, false);
    double before = s.stage.read(s.probe).position.y;
    for (int i = 0; i < 16; ++i) {
      s.run(1);
      const double y = s.stage.read(s.probe).position.y;
      EXPECT_LE(before - y, 0.0005 / 8) << "a frame's way is spread over its ticks";
      before = y;
    }
  }
  s.run(20);
  EXPECT_TRUE(s.stage.read(s.probe).in_contact);
  EXPECT_NEAR(s.stage.read(s.probe).normal_force, 300 * 0.004, 0.02);
}

// Delayed frames arrive in two consecutive ticks, with a large pointer motion between them.
TEST(Mouse, AJumpOfAPressIsTravelledNoFasterThanAHandWould) {
  MouseScene s;
  s.say({0, 0.15, 0}, true);
  s.run(16);
  s.say({0, 0.15, 0}, false);
  s.run(1);
  const dvec3 goal(0.03, 0.14, 0);
  s.say(goal, false);
  dvec3 before = s.stage.device(s.probe).position;
  int ticks = 0;
  for (; ticks < 200 && s.stage.device(s.probe).position != goal; ++ticks) {
    s.run(1);
    const dvec3 now = s.stage.device(s.probe).position;
    EXPECT_LE(length(now - before), kMouseFastest * 1e-3 * (1 + 1e-9)) << "tick " << ticks;
    before = now;
  }
  EXPECT_EQ(ticks, static_cast<int>(std::ceil(length(goal - dvec3(0, 0.15, 0)) / kMouseFastest / 1e-3)));
}

TEST(Mouse, AWayOutThatIsNotOverIsTravelledToItsEndHoweverManyPicturesHover) {
  MouseScene s;
  s.say({0, 0.102, 0}, false);
  s.run(200);
  for (int picture = 0; picture < 3; ++picture) {
    s.say({0, 0.2, 0}, true);
    s.run(2);
    EXPECT_LT(s.stage.device(s.probe).position.y, 0.11) << "picture " << picture;
  }
}

TEST(Mouse, LettingGoOfAPressGivesOutNoEnergy) {
  MouseScene s;
  scenes::WorkMeter meter;
  double stored = 0.0, sampled = 0.0;  // [J] upper bounds; the error from releasing a spring within a step
  ProbeReading last;
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      s.run(1);
      const ProbeReading now = s.stage.read(s.probe);
      meter.add(now);
      stored = std::max(stored, -meter.work());
      sampled = std::max(sampled, 0.25 * length(now.force - last.force) * length(now.position - last.position));
      last = now;
    }
  };
  s.say({0, 0.102, 0}, true);
  run(16);
  for (int frame = 1; frame <= 12; ++frame) {
    s.say({0, 0.102 - 0.0005 * frame, 0}, false);
    run(16);
  }
  s.say({0, 0.115, 0}, true);  // a slow frame: out in one frame
  run(100);
  s.say({0, 0.12, 0}, true);
  run(16);
  EXPECT_FALSE(s.stage.read(s.probe).in_contact);
  EXPECT_LE(meter.work(), kPassivityShare * stored + sampled);
  EXPECT_LE(meter.work(), 0.1 * stored);
}

TEST(Mouse, SilenceOfAQuarterSecondLetsGo) {
  MouseScene s;
  s.say({0, 0.102, 0}, true);
  s.run(16);
  for (int frame = 1; frame <= 12; ++frame) {
    s.say({0, 0.102 - 0.0005 * frame, 0}, false);
    s.run(16);
  }
  s.run(200);
  EXPECT_GT(s.stage.read(s.probe).normal_force, 1.0) << "a slow picture is no silence";
  s.run(100);
  EXPECT_EQ(s.stage.read(s.probe).force, dvec3(0));
}

}  // namespace
}  // namespace pliant
