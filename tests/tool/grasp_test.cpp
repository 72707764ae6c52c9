// The shipped level `grasp`: fingers closed by the grip lift a soft ball, turn it over and put it down; with little
// friction it slips out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "content/level_file.h"
#include "systems/prepare_world.h"
#include "systems/schedule.h"
#include "systems/soft/soft_state.h"
#include "systems/tool/tool_step.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

constexpr double kGraspTick = 1e-3;  // [s]

struct Grasp {
  World world;
  Schedule<World> touch{touch_schedule()}, soft{soft_schedule()};
  std::uint64_t tick = 0, steps = 0;
  double largest = 0.0;  // [N] on the hand

  explicit Grasp(double friction = 0.0) {
    Result<Level> level = load_level(std::string(PLIANT_SOURCE_DIR) + "/content/levels/grasp.glb");
    EXPECT_TRUE(level.ok());
    Result<World> spawned = spawn(*level);
    EXPECT_TRUE(spawned.ok());
    world = std::move(spawned).value();
    if (friction > 0.0) {
      for (auto [entity, body] : world.registry.view<SoftBody>())
        body.friction_static = body.friction_sliding = friction;
      for (auto [entity, body] : world.registry.view<RigidBody>())
        body.friction_static = body.friction_sliding = friction;
    }
    const Status status = prepare_world(world);
    EXPECT_TRUE(status.ok());
  }
  void run(double until) {
    const double step = world.simulation.soft_step;
    for (; static_cast<double>(tick) * kGraspTick < until - 1e-9; ++tick) {
      const double now = static_cast<double>(tick) * kGraspTick;
      while (static_cast<double>(steps) * step <= now + 1e-9) {
        run_soft_step(soft, world, {steps, step, static_cast<double>(steps) * step});
        ++steps;
      }
      touch.run(world, {tick, kGraspTick, now});
      const HapticDevice& device = world.registry.get<HapticDevice>(find_by_name(world, "palm"));
      largest = std::max(largest, length(device.force_sent));
    }
  }
  const Body& body(const char* name) const {
    const Entity entity = find_by_name(world, name);
    return **std::find_if(world.soft->bodies.begin(), world.soft->bodies.end(),
                          [&](const auto& b) { return b->entity == entity; });
  }
  dvec3 ball() const {  // [m] its middle
    dvec3 sum(0.0);
    for (const dvec3& x : body("ball").surface_position) sum += x;
    return sum / static_cast<double>(body("ball").surface_position.size());
  }
  double leans() const {  // [1] cosine of the palm's tilt
    return (body("palm").pose_after(0.0)->rotation * dvec3(0, 1, 0)).y;
  }
};

TEST(Grasp, LiftsTurnsOverAndPutsDownASoftBall) {
  Grasp scene;
  scene.run(0.8);
  const dvec3 first = scene.ball();
  scene.run(2.7);
  EXPECT_NEAR(scene.ball().y - first.y, 0.20, 0.01) << "[m] lifted";
  scene.run(4.6);
  EXPECT_LT(scene.leans(), -0.95);
  EXPECT_NEAR(scene.ball().y - first.y, 0.20, 0.015) << "[m] held upside down";
  EXPECT_LT(std::hypot(scene.ball().x, scene.ball().z), 0.015);
#ifndef PLIANT_SANITIZED  // the way back takes as long again
  scene.run(7.9);
  EXPECT_NEAR(scene.ball().y, first.y, 0.002) << "[m] put down";
#endif
  const SoftTally& tally = scene.world.soft->tally;
  EXPECT_EQ(tally.halted_for, 0.0);
  EXPECT_LT(tally.deepest, 1e-3);
  EXPECT_LT(scene.largest, 4.0) << "[N]";
  for (std::size_t i = 0; i < scene.world.soft->joints.size(); ++i) {
    const JointReport& joint = scene.world.soft->joints.report(i);
    EXPECT_LT(joint.apart, 1e-3);
    EXPECT_LE(joint.work, joint.fed + 1e-6) << "[J] a drive gives what it is fed";
  }
}

TEST(Grasp, LosesABallThatSlips) {
  Grasp scene(0.1);
  scene.run(0.8);
  const dvec3 first = scene.ball();
  scene.run(2.7);
  EXPECT_LT(scene.ball().y - first.y, 0.02);
}

}  // namespace
}  // namespace pliant
