// The shipped level `grasp`: fingers closed by the grip lift a soft ball, turn it over and put it down; with little
// friction it slips out.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/tool/tool_level_run.h"

namespace pliant {
namespace {

struct Grasp : test::ToolLevelRun {
  explicit Grasp(double friction = 0.0)
      : ToolLevelRun("grasp", [&](World& world) {
          if (friction == 0.0) return;
          for (auto [entity, body] : world.registry.view<SoftBody>())
            body.friction_static = body.friction_sliding = friction;
          for (auto [entity, body] : world.registry.view<RigidBody>())
            body.friction_static = body.friction_sliding = friction;
        }) {}
  dvec3 ball() const { return middle("ball"); }
  double leans() const {  // [1] cosine of the palm's tilt
    return (body("palm").pose_after(0.0)->rotation * dvec3(0, 1, 0)).y;
  }
};

TEST(Grasp, LiftsTurnsOverAndPutsDownASoftBall) {
  Grasp scene;
  scene.run(0.8);
  EXPECT_LT(scene.largest, 0.03) << "[N] in free air: its inertia, without its weight";
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
