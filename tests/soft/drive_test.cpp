// Driven joints (PLIANT_joint: stiffness, rest, grip, max_force) against closed forms, and what they may give.
#include <gtest/gtest.h>

#include "systems/tool/tool_touch_state.h"
#include "tests/soft/jointed.h"

namespace pliant::test {
namespace {

constexpr double kRodLong = 0.3;                              // [m] of a rod that hangs from the origin
constexpr double kRodMass = 0.02 * kRodLong * 0.03 * 1000.0;  // [kg]
constexpr double kRodInertia =
    kRodMass * ((kRodLong * kRodLong + 0.02 * 0.02) / 12.0 + 0.25 * kRodLong * kRodLong);  // [kg m2]

// A rod on a hinge about +Z, driven from straight down.
struct Driven : Jointed {
  Entity rod, hand;
  Driven(double step, JointParameters joint, double gravity, Track target = {}) : Jointed(step) {
    stage.world.simulation.gravity = dvec3(0, -gravity, 0);
    rod = box(dvec3(0.02, kRodLong, 0.03), dvec3(0, -0.5 * kRodLong, 0));
    hand = stage.world.registry.create();
    joint.kind = JointKind::kHinge;
    join(joint, rod, kNoEntity, dvec3(0), kAcross, joint.grip.empty() ? kNoEntity : hand);
    for (auto [entity, made] : stage.world.registry.view<Joint>()) made.target = target, made.repeats = false;
    stage.prepare();
  }
  double angle() {
    const dvec3 c = rigid(rod).centre();
    return std::atan2(c.x, -c.y);
  }
  const JointReport& report() { return joints().report(0); }
};

// Under-damped and over-damped: theta'' = (K (rest - theta) - D theta') / I.
TEST(Drives, StepToTheirTargetAsASpringAndADamperWithInertiaDo) {
  for (const double ratio : {0.3, 2.0}) {
    const double K = 0.4, w = std::sqrt(K / kRodInertia), D = 2.0 * ratio * w * kRodInertia;
    double last = 0.0;
    for (const double step : {2e-3, 1e-3}) {
      Driven scene(step, {.stiffness = K, .damping = D, .rest = 0.5}, 0.0);
      double worst = 0.0;
      for (int i = 1; i <= 10; ++i) {
        scene.run(0.04);
        const double t = 0.04 * i, s = w * std::sqrt(std::abs(1.0 - ratio * ratio));
        const double swing = ratio < 1.0 ? std::cos(s * t) + ratio * w / s * std::sin(s * t)
                                         : std::cosh(s * t) + ratio * w / s * std::sinh(s * t);
        worst = std::max(worst, std::abs(scene.angle() - 0.5 * (1.0 - std::exp(-ratio * w * t) * swing)));
      }
      EXPECT_LT(worst, 6.0 * step) << ratio;  // [rad] of an implicit step, first order
      if (last > 0.0) EXPECT_NEAR(worst / last, 0.5, 0.05) << ratio;
      last = worst;
    }
  }
}

TEST(Drives, BalanceAWeightWithTheTorqueOfTheirSpring) {
  Driven scene(1.0 / 60.0, {.stiffness = 2.0, .damping = 0.2, .rest = 1.2}, kG);
  scene.run(6.0);
  const double at = scene.angle(), weighs = kRodMass * kG * 0.5 * kRodLong * std::sin(at);
  EXPECT_NEAR(2.0 * (1.2 - at), weighs, 1e-4 * weighs);
  EXPECT_NEAR(std::abs(scene.report().push), weighs, 1e-4 * weighs);
  EXPECT_EQ(scene.report().limited_for, 0.0);
}

TEST(Drives, FollowAnAnimation) {
  Track target;
  target.times = {0.0, 1.0, 2.0}, target.length = 2.0;
  target.values = {{0.0, 0, 0, 0}, {0.8, 0, 0, 0}, {-0.4, 0, 0, 0}};
  Driven scene(1.0 / 60.0, {.stiffness = 500.0, .damping = 1.0}, kG, target);
  for (const double due : {0.4, 0.8, 0.2, -0.4, -0.4}) {
    scene.run(0.5);
    EXPECT_NEAR(scene.angle(), due, 0.004);
  }
}

// At its bound a drive accelerates evenly: theta_n = M/I T^2 n (n + 1) / 2.
TEST(Drives, KeepTheirBoundExactly) {
  constexpr double kMost = 0.02, kStep = 1e-3;  // [N m], [s]
  Driven scene(kStep, {.stiffness = 100.0, .damping = 0.5, .rest = 3.0, .max_force = kMost}, 0.0);
  constexpr int kSteps = 150;
  for (int i = 0; i < kSteps; ++i) {
    scene.stage.step();
    ASSERT_NEAR(std::abs(scene.report().push), kMost, 1e-9 * kMost) << i;
  }
  EXPECT_NEAR(scene.report().limited_for, kSteps * kStep, 1e-9);
  const double due = kMost / kRodInertia * kStep * kStep * kSteps * (kSteps + 1) / 2.0;
  EXPECT_NEAR(scene.angle(), due, 1e-3 * due);
}

// A grip that opens and closes while the rod is thrown about: what the drive did on it is never more than what its
// moving rest gave, and ends as that less what the damper took.
TEST(Drives, GiveNoMoreThanTheMotionOfTheirRestFeeds) {
  for (const double most : {0.0, 0.05}) {
    Driven scene(1.0 / 60.0,
                 {.stiffness = 1.5, .damping = 0.01, .rest = -0.4, .closed = 1.4, .grip = "hand", .max_force = most},
                 kG);
    scene.rigid(scene.rod).set_velocity(dvec3(0.6, 0, 0), dvec3(0, 0, 4.0));
    double held = 0.5 * 1.5 * 0.4 * 0.4, largest = 0.0;
    if (most > 0.0) held = most * (0.4 - 0.5 * most / 1.5);
    for (int i = 0; i < 600; ++i) {
      scene.joints().set_grip(scene.hand, 0.5 - 0.5 * std::cos(0.13 * i));
      scene.stage.step();
      ASSERT_LE(scene.report().work, scene.report().fed + held + 1e-6) << most << ' ' << i;
      if (most > 0.0) ASSERT_LE(std::abs(scene.report().push), most * (1.0 + 1e-9));
      largest = std::max(largest, scene.report().work);
    }
    EXPECT_GT(largest, 0.02) << most;  // [J] it does lift the rod
  }
}

// The force that drives a part along a tool pushes the tool back: felt at 1 kHz, however the force is computed.
TEST(Drives, OnAToolAreFelt) {
  for (const ToolForce force : {ToolForce::kHeld, ToolForce::kLinear, ToolForce::kContacts}) {
    Jointed scene(1.0 / 60.0);
    scene.stage.world.simulation.gravity = dvec3(0);
    Handle6 handle;
    handle.force = force;
    const Entity tool = scene.stage.add_rigid(scenes::box(dvec3(0.03)), RigidBody{}, Pose{}, &handle);
    const Entity part = scene.box(dvec3(0.03), dvec3(0, -0.04, 0));
    scene.join({.kind = JointKind::kSlider,
                .stiffness = 1e3,
                .damping = 1.0,
                .closed = -50.0,
                .grip = "tool",
                .max_force = 0.2},
               part, tool, dvec3(0, -0.04, 0), kUpright, tool);
    scene.stage.prepare();
    scene.stage.device_of(tool).grip = 1.0;
    scene.stage.run(0.4);
    dvec3 least(1e9), most(-1e9);
    scene.stage.lead(tool, dvec3(0), 0.3, [&] {
      const dvec3 f = scene.stage.device_of(tool).force_sent;
      least = glm::min(least, f), most = glm::max(most, f);
    });
    EXPECT_NEAR(least.y, 0.2, 0.01) << int(force);
    EXPECT_NEAR(most.y, 0.2, 0.01) << int(force);
  }
}

}  // namespace
}  // namespace pliant::test
