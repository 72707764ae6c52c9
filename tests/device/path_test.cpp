// Repeating scripts: their poses, and that nothing jumps.
#include "systems/device/path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/device/repeat.h"

namespace pliant {
namespace {

const Path kOpen{{{0, {0, 0, 0}}, {1, {0.1, 0, 0}}, {3, {0.1, 0.2, 0}}}, false, false};
const Path kClosed{{{0, {0, 0, 0}}, {1, {0.1, 0, 0}}, {2, {0, 0, 0}}}, false, false};

TEST(Repeat, AScriptThatEndsElsewhereIsFollowedBackInReverse) {
  EXPECT_EQ(period_of(kOpen), 6.0);
  const Path there_and_back = repeated(kOpen, 0.0);
  for (double t = 0.0; t <= 3.0; t += 0.01) {
    const dvec3 there = sample_path(kOpen, t).position;
    EXPECT_EQ(sample_path(there_and_back, t).position, there) << t;
    EXPECT_LT(length(sample_path(there_and_back, 6.0 - t).position - there), 1e-12) << t;
    EXPECT_LT(length(sample_path(there_and_back, 12.0 + t).position - there), 1e-12) << t;
  }
}

TEST(Repeat, OneThatEndsWhereItBeginsStartsOverAfterItHasWaitedForLongerOnes) {
  EXPECT_EQ(period_of(kClosed), 2.0);
  const Path alone = repeated(kClosed, 0.0), waiting = repeated(kClosed, 6.0);
  EXPECT_LT(length(sample_path(alone, 3.0).position - dvec3(0.1, 0, 0)), 1e-12);
  EXPECT_EQ(sample_path(waiting, 3.0).position, dvec3(0));
  EXPECT_LT(length(sample_path(waiting, 7.0).position - dvec3(0.1, 0, 0)), 1e-12);
}

TEST(Repeat, NothingMovesFasterThanInTheScriptNotEvenWhereItStartsOver) {
  Path turning{{{-0.5, {0, 0, 0}},
                {0.5, {0.1, 0, 0}, glm::angleAxis(1.0, dvec3(0, 1, 0))},
                {1.5, {0.1, 0.1, 0}, glm::angleAxis(2.0, dvec3(0, 1, 0))}},
               true,
               false};
  for (const Path& script : {kOpen, kClosed, turning, Path{{{2, {1, 2, 3}}}, false, false}}) {
    const Path path = repeated(script, 7.0);
    PathRow before = sample_path(path, 0.0);
    EXPECT_LT(length(before.position - sample_path(script, 0.0).position), 1e-12);
    for (int i = 1; i < 30000; ++i) {
      const PathRow now = sample_path(path, 1e-3 * i);
      ASSERT_LT(length(now.position - before.position), 0.11e-3) << i;                 // 0.1 m/s
      ASSERT_GT(std::abs(dot(now.rotation, before.rotation)), std::cos(0.6e-3)) << i;  // 1 rad/s
      before = now;
    }
  }
}

TEST(Repeat, ScriptsOfAWorldStartOverTogether) {
  World world;
  const auto add = [&](const Path& path) {
    const Entity entity = world.registry.create();
    HapticDevice device;
    device.driver = DriverKind::kScript;
    device.path = world.paths.add(path);
    world.registry.add<HapticDevice>(entity, device);
    return entity;
  };
  const Entity open = add(kOpen), closed = add(kClosed);
  repeat_scripts(world);
  for (const double t : {0.5, 1.5, 2.9})
    for (const Entity entity : {open, closed}) {
      const Path& path = world.paths[world.registry.get<HapticDevice>(entity).path];
      EXPECT_LT(length(sample_path(path, t).position - sample_path(path, t + 6.0).position), 1e-12) << t;
    }
}

}  // namespace
}  // namespace pliant
