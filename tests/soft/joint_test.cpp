// Joints between bodies (PLIANT_joint), against closed forms and conserved quantities.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/prepare_world.h"
#include "systems/tool/tool_touch_state.h"
#include "tests/soft/jointed.h"

namespace pliant::test {
namespace {

// theta'' = -w2 sin(theta), by fourth-order Runge-Kutta.
double swung(double theta, double w2, double seconds) {
  double rate = 0.0;
  const int steps = 20000;
  const double h = seconds / steps;
  for (int i = 0; i < steps; ++i) {
    const auto f = [&](double x) { return -w2 * std::sin(x); };
    const double k1 = rate, l1 = f(theta), k2 = rate + 0.5 * h * l1, l2 = f(theta + 0.5 * h * k1),
                 k3 = rate + 0.5 * h * l2, l3 = f(theta + 0.5 * h * k2), k4 = rate + h * l3, l4 = f(theta + h * k3);
    theta += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4), rate += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
  }
  return theta;
}

constexpr double kLong = 0.3;  // [m] of the pendulum
// Hung at the origin, `angle` from straight down.
Entity add_pendulum(Jointed& scene, double angle) {
  const dquat turned = glm::angleAxis(angle, dvec3(0, 0, 1));
  const Entity rod = scene.box(dvec3(0.02, kLong, 0.03), turned * dvec3(0, -0.5 * kLong, 0), turned);
  scene.join(of_kind(JointKind::kHinge), rod, kNoEntity, dvec3(0), kAcross);
  return rod;
}

TEST(Joints, APendulumOnAHingeSwingsByItsEquation) {
  const double begun = 1.0, inertia = (kLong * kLong + 0.02 * 0.02) / 12.0 + 0.25 * kLong * kLong;
  const double w2 = 0.5 * kLong * kG / inertia;
  for (const double step : {1e-3, 1.0 / 240.0}) {
    Jointed scene(step);
    const Entity rod = add_pendulum(scene, begun);
    scene.stage.prepare();
    double worst = 0.0;
    for (int i = 1; i <= 4; ++i) {
      scene.run(0.25);
      const dvec3 c = scene.rigid(rod).centre();
      worst = std::max(worst, std::abs(std::atan2(c.x, -c.y) - swung(begun, w2, 0.25 * i)));
    }
    EXPECT_LT(worst, 8.0 * step) << step;  // [rad] the step's own lag, of first order
  }
}

TEST(Joints, KeepAPendulumsEnergyAndItsPlace) {
  for (const double begun : {0.3, 1.5, 3.0}) {
    Jointed scene(1.0 / 60.0);
    const Entity rod = add_pendulum(scene, begun);
    scene.stage.prepare();
    const double depth = scene.rigid(rod).mass().mass * kG * 0.5 * kLong;
    const double first = scene.energy({rod});
    double mean = 0.0;
    constexpr int kSteps = 60 * 30;
    for (int i = 0; i < kSteps; ++i) {
      scene.stage.step();
      const Pose pose = scene.rigid(rod).pose();
      ASSERT_LT(length(pose.to_world(dvec3(0, 0.5 * kLong, 0))), 1e-7) << begun << " step " << i;
      ASSERT_LT(std::abs((pose.rotation * dvec3(0, 0, 1)).z - 1.0), 1e-9);
      if (i >= kSteps / 2) mean += scene.energy({rod}) / (kSteps / 2);
    }
    EXPECT_NEAR(mean, first, 0.05 * depth) << begun;  // neither lost nor gained in 30 s at 1/60 s
  }
}

TEST(Joints, OfAChainCarryWhatHangsBelow) {
  constexpr int kLinks = 12;
  Jointed scene(1.0 / 60.0);
  std::vector<Entity> links;
  for (int i = 0; i < kLinks; ++i) {
    links.push_back(scene.box(dvec3(0.01, 0.04, 0.01), dvec3(0, -0.02 - 0.04 * i, 0)));
    scene.join(of_kind(JointKind::kBall), links.back(), i ? links[links.size() - 2] : kNoEntity,
               dvec3(0, -0.04 * i, 0));
  }
  scene.run(1.0);
  const double weight = scene.rigid(links[0]).mass().mass * kG;
  for (int i = 0; i < kLinks; ++i)
    EXPECT_NEAR(scene.joints().report(std::size_t(i)).force, weight * (kLinks - i), 1e-5 * weight * kLinks) << i;
  EXPECT_NEAR(scene.rigid(links.back()).centre().y, -0.02 - 0.04 * (kLinks - 1), 1e-7);
}

// Explicit rows are unstable there: the upper links turn within less than a step.
TEST(Joints, OfAChainThatSwingsWithAWeightAtItsEndStayStable) {
  constexpr int kLinks = 12;
  for (const auto& [step, size] : {std::pair(1.0 / 60.0, 0.02), std::pair(1.0 / 240.0, 0.05)}) {
    Jointed scene(step);
    std::vector<Entity> bodies;
    const dquat lean = glm::angleAxis(0.7, dvec3(0, 0, 1));
    for (int i = 0; i <= kLinks; ++i) {
      const dvec3 at = lean * dvec3(0, -0.04 * i, 0);
      bodies.push_back(i < kLinks ? scene.box(dvec3(0.01, 0.04, 0.01), at + lean * dvec3(0, -0.02, 0), lean)
                                  : scene.box(dvec3(size), at - lean * dvec3(0, 0.5 * size, 0), lean));
      scene.join(of_kind(JointKind::kBall), bodies.back(), i ? bodies[bodies.size() - 2] : kNoEntity, at);
    }
    scene.stage.prepare();
    const double first = scene.energy(bodies), most = scene.rigid(bodies.back()).mass().mass * kG * 0.04 * kLinks;
    double gained = 0.0, apart = 0.0;
    for (int i = 0; i < int(20.0 / step); ++i) {
      scene.stage.step();
      gained = std::max(gained, scene.energy(bodies) - first);
    }
    for (std::size_t i = 0; i < scene.joints().size(); ++i) apart = std::max(apart, scene.joints().report(i).apart);
    EXPECT_LT(gained, 0.02 * most) << step;
    EXPECT_LT(apart, 1e-4) << step;
    EXPECT_EQ(scene.stage.soft().tally.unconverged, 0u);
  }
}

TEST(Joints, ASliderSlidesAlongItsAxisAlone) {
  for (const double slope : {0.2, 0.7, 1.3}) {
    Jointed scene(1e-3);
    const dquat turned = glm::angleAxis(slope, dvec3(0, 0, 1));  // +Y leans by the slope from upright
    const Entity sled = scene.box(dvec3(0.05, 0.02, 0.03), dvec3(0));
    scene.join(of_kind(JointKind::kSlider), sled, kNoEntity, dvec3(0.01, 0.02, 0), turned);
    scene.run(0.5);
    const dvec3 way = turned * dvec3(0, -1, 0);
    const RigidState& body = scene.rigid(sled);
    const double went = dot(body.centre(), way);
    EXPECT_NEAR(went, 0.5 * kG * std::cos(slope) * 0.25, 0.003 * went) << slope;
    EXPECT_LT(length(body.centre() - went * way), 1e-7) << slope;
    EXPECT_LT(std::abs(body.rotation().w - 1.0), 1e-9) << slope;
  }
}

TEST(Joints, FixedPartsMoveAsOneBody) {
  Jointed scene(1e-3);
  scene.stage.world.simulation.gravity = dvec3(0);
  const Entity left = scene.box(dvec3(0.1, 0.05, 0.05), dvec3(-0.05, 0, 0)),
               right = scene.box(dvec3(0.1, 0.05, 0.05), dvec3(0.05, 0, 0));
  scene.join(of_kind(JointKind::kFixed), left, right, dvec3(0));
  Jointed one(1e-3);
  one.stage.world.simulation.gravity = dvec3(0);
  const Entity whole = one.box(dvec3(0.2, 0.05, 0.05), dvec3(0));
  scene.stage.prepare(), one.stage.prepare();
  const dvec3 spin(0.3, 5.0, 1.0);
  one.rigid(whole).set_velocity(dvec3(0.1, 0, 0), spin);
  for (const Entity e : {left, right})
    scene.rigid(e).set_velocity(dvec3(0.1, 0, 0) + cross(spin, scene.rigid(e).centre()), spin);
  scene.run(1.0), one.run(1.0);
  const Pose expected = one.rigid(whole).pose(), found = scene.rigid(left).pose();
  EXPECT_LT(length(found.position - expected.to_world(dvec3(-0.05, 0, 0))), 2e-3);
  EXPECT_GT(std::abs(dot(found.rotation, expected.rotation)), 1.0 - 1e-3);
  EXPECT_LT(length(found.to_local(scene.rigid(right).pose().position) - dvec3(0.1, 0, 0)), 1e-7);
}

TEST(Joints, KeepMomentum) {
  for (const JointKind kind : kJointKinds) {
    Jointed scene(1.0 / 60.0);
    scene.stage.world.simulation.gravity = dvec3(0);
    const Entity a = scene.box(dvec3(0.05, 0.1, 0.03), dvec3(0, 0.06, 0)),
                 b = scene.box(dvec3(0.07), dvec3(0, -0.06, 0));
    JointParameters joint = of_kind(kind);
    joint.end = dvec3(0, -0.05, 0), joint.limits = {-0.4, 0.2}, joint.stiffness = 0.5, joint.damping = 0.01;
    scene.join(joint, a, b, dvec3(0, 0.02, 0), kAcross);
    scene.stage.prepare();
    scene.rigid(a).set_velocity(dvec3(0.2, 0.4, 0.1), dvec3(3, 1, 2));
    const auto momenta = [&] {
      std::pair<dvec3, dvec3> sum{0.0, 0.0};
      for (const Entity e : {a, b}) {
        const RigidState& body = scene.rigid(e);
        const dvec3 p = body.mass().mass * dvec3(body.velocity()[0], body.velocity()[1], body.velocity()[2]);
        sum.first += p, sum.second += cross(body.centre(), p) + body.angular_momentum();
      }
      return sum;
    };
    scene.run(1.0 / 60.0);
    const auto first = momenta();
    scene.run(2.0);
    const auto last = momenta();
    EXPECT_LT(length(last.first - first.first), 1e-9) << kJointRows[std::size_t(kind)].word;
    EXPECT_LT(length(last.second - first.second), 1e-6 * length(first.second)) << kJointRows[std::size_t(kind)].word;
  }
}

TEST(Joints, ASpringOfAHingeHasItsPeriodAndLimitsItsStop) {
  const double inertia = 0.02 * kLong * 0.03 * 1000.0 * ((kLong * kLong + 0.02 * 0.02) / 12.0 + 0.25 * kLong * kLong);
  for (const double stiffness : {0.05, 2.0}) {
    Jointed scene(1e-3);
    scene.stage.world.simulation.gravity = dvec3(0);
    const Entity rod = scene.box(dvec3(0.02, kLong, 0.03), dvec3(0, -0.5 * kLong, 0));
    JointParameters joint = of_kind(JointKind::kHinge);
    joint.stiffness = stiffness, joint.rest = 0.5;
    scene.join(joint, rod, kNoEntity, dvec3(0), kAcross);
    scene.run(0.25 * 2.0 * std::numbers::pi * std::sqrt(inertia / stiffness));  // a quarter: at rest's angle
    const dvec3 c = scene.rigid(rod).centre();
    EXPECT_NEAR(std::atan2(c.x, -c.y), 0.5, 0.01) << stiffness;
  }
  Jointed scene(1.0 / 60.0);
  const Entity rod = scene.box(dvec3(0.02, kLong, 0.03), dvec3(0, 0.5 * kLong, 0), glm::angleAxis(0.0, dvec3(0, 0, 1)));
  JointParameters joint = of_kind(JointKind::kHinge);
  joint.limits = {-0.6, 0.1};
  scene.join(joint, rod, kNoEntity, dvec3(0), kAcross);
  scene.stage.prepare();
  scene.rigid(rod).set_velocity(dvec3(0.075, 0, 0), dvec3(0, 0, -0.5));
  scene.run(3.0);
  const dvec3 c = scene.rigid(rod).centre();
  EXPECT_NEAR(std::atan2(-c.x, c.y), -0.6, 1e-6);
  EXPECT_LT(scene.rigid(rod).velocity().norm(), 1e-5);
}

TEST(Joints, ARopePullsAndDoesNotPush) {
  Jointed scene(1.0 / 60.0);
  const Entity ball = scene.box(dvec3(0.04), dvec3(0.05, 0, 0));
  JointParameters rope = of_kind(JointKind::kRope);
  rope.end = dvec3(-0.05, 0.02, 0), rope.length = 0.2;
  scene.join(rope, ball, kNoEntity, dvec3(0.05, 0.02, 0));  // at the ball's top, tied above the origin
  scene.run(0.1);
  EXPECT_EQ(scene.joints().report(0).largest, 0.0);
  scene.run(0.4);
  const RigidState& body = scene.rigid(ball);
  const auto stretched = [&] { return length(body.pose().to_world(dvec3(0, 0.02, 0)) - dvec3(0, 0.04, 0)) - 0.2; };
  for (int i = 0; i < 120; ++i) {
    scene.stage.step();
    ASSERT_LT(stretched(), 5e-6) << i;
  }
  EXPECT_GT(scene.joints().report(0).largest, body.mass().mass * kG);

  rope.stiffness = 20.0, rope.damping = 1.0, rope.length = 0.0, rope.end = dvec3(0, 0.1, 0);
  Jointed soft(1.0 / 60.0);
  const Entity hung = soft.box(dvec3(0.04), dvec3(0));
  soft.join(rope, hung, kNoEntity, dvec3(0));
  soft.run(6.0);
  const double weight = soft.rigid(hung).mass().mass * kG;
  EXPECT_NEAR(soft.rigid(hung).centre().y, -weight / 20.0, 1e-4 * weight / 20.0);
  EXPECT_NEAR(soft.joints().report(0).force, weight, 1e-3 * weight);
}

TEST(Joints, BreakBeyondTheirStrength) {
  for (const bool holds : {true, false}) {
    Jointed scene(1.0 / 60.0);
    const Entity body = scene.box(dvec3(0.04), dvec3(0));
    JointParameters joint = of_kind(JointKind::kBall);
    joint.strength = (holds ? 1.1 : 0.9) * 0.04 * 0.04 * 0.04 * 1000.0 * kG;
    scene.join(joint, body, kNoEntity, dvec3(0, 0.02, 0));
    scene.run(0.5);
    EXPECT_EQ(scene.joints().report(0).broke_at < 0.0, holds);
    EXPECT_EQ(scene.rigid(body).centre().y > -1e-6, holds);
  }
}

// Its load falls on as if it had never been there.
TEST(Joints, ARopeThatBreaksLeavesVelocitiesAsTheyAre) {
  Jointed scene(1.0 / 60.0);
  const Entity free = scene.box(dvec3(0.04), dvec3(1, 0, 0)), tied = scene.box(dvec3(0.04), dvec3(0));
  JointParameters rope = of_kind(JointKind::kRope);
  rope.length = 0.2, rope.strength = 0.5, rope.end = dvec3(0, 0.02, 0);
  scene.join(rope, tied, kNoEntity, dvec3(0, 0.02, 0));
  scene.run(0.19);
  ASSERT_LT(scene.joints().report(0).broke_at, 0.0);
  scene.run(0.21);
  EXPECT_GT(scene.joints().report(0).broke_at, 0.19);
  EXPECT_GT(scene.joints().report(0).largest, rope.strength);
  EXPECT_EQ(scene.rigid(tied).velocity()[1], scene.rigid(free).velocity()[1]);
  EXPECT_EQ(scene.rigid(tied).centre().y, scene.rigid(free).centre().y);
}

TEST(Joints, TissueHangsByItsWeightAndCarriesARigidPart) {
  Jointed scene(1.0 / 60.0);
  SoftBody gel = pile_rubber();
  const Entity tissue = scene.stage.add_soft(tets::box(3, 3, 3, dvec3(-0.015), dvec3(0.015)), gel, Pose{});
  const Entity weight = scene.box(dvec3(0.03, 0.01, 0.03), dvec3(0, -0.02, 0));
  scene.join(of_kind(JointKind::kFixed), tissue, kNoEntity, dvec3(0, 0.015, 0));
  scene.join(of_kind(JointKind::kFixed), weight, tissue, dvec3(0, -0.015, 0));
  scene.run(4.0);
  const double below = scene.rigid(weight).mass().mass * kG, all = below + 0.03 * 0.03 * 0.03 * gel.density * kG;
  EXPECT_NEAR(scene.joints().report(0).force, all, 1e-3 * all);
  EXPECT_NEAR(scene.joints().report(1).force, below, 1e-3 * below);
  EXPECT_LT(scene.rigid(weight).centre().y, -0.02);
}

// A part that hangs from a tool is felt by its weight, at 1 kHz.
TEST(Joints, WhatHangsFromAToolIsFelt) {
  for (const ToolForce force : {ToolForce::kHeld, ToolForce::kLinear, ToolForce::kContacts}) {
    Jointed scene(1.0 / 60.0);
    Handle6 handle;
    handle.force = force;
    const Entity tool = scene.stage.add_rigid(scenes::box(dvec3(0.03)), RigidBody{}, Pose{}, &handle);
    const Entity hung = scene.box(dvec3(0.03), dvec3(0, -0.04, 0));
    scene.join(of_kind(JointKind::kBall), hung, tool, dvec3(0, -0.015, 0));
    scene.stage.prepare();
    const double weight = scene.rigid(hung).mass().mass * kG;
    dvec3 least(1e9), most(-1e9);
    scene.stage.run(2.0);
    scene.stage.lead(tool, dvec3(0), 0.5, [&] {
      const dvec3 f = scene.stage.device_of(tool).force_sent;
      least = glm::min(least, f), most = glm::max(most, f);
    });
    EXPECT_NEAR(least.y, -weight, 0.02 * weight) << int(force);
    EXPECT_NEAR(most.y, -weight, 0.02 * weight) << int(force);
    EXPECT_LT(std::max(std::abs(least.x), std::abs(most.z)), 0.02 * weight) << int(force);
  }
}

// The account of a hand has the work of gravity on what it is joined to in the step in which that moves.
TEST(Joints, TheWorkOfTheirBodiesWeightIsCreditedInItsStep) {
  Jointed scene(1.0 / 60.0);
  const Handle6 handle;
  const Entity tool = scene.stage.add_rigid(scenes::box(dvec3(0.03)), RigidBody{}, Pose{}, &handle);
  const Entity hung = scene.box(dvec3(0.03), dvec3(0.05, 0, 0));
  scene.join(of_kind(JointKind::kHinge), hung, tool, dvec3(0.02, 0, 0), kAcross);
  scene.stage.prepare();
  const double weight = scene.rigid(hung).mass().mass * kG;                   // the tool's own is carried
  const auto height = [&] { return weight * scene.rigid(hung).centre().y; };  // [J]
  const double first = height();
  scene.stage.lead(tool, dvec3(0), 0.3,
                   [&] { ASSERT_NEAR(scene.stage.world.tools->tools[0]->model.read().fed, first - height(), 1e-12); });
  EXPECT_LT(height(), first - 1e-3);
}

TEST(Joints, OfFixedBodiesAndSlidersOfTissueAreRefused) {
  {
    Jointed scene(1.0 / 60.0);
    scene.box(dvec3(0.02), dvec3(0, 1, 0));
    const Entity wall = scene.stage.add_rigid(scenes::box(dvec3(0.1)), fixed(), Pose{});
    scene.join(of_kind(JointKind::kBall), wall, kNoEntity, dvec3(0));
    const Status status = prepare_world(scene.stage.world);
    ASSERT_FALSE(status);
    EXPECT_NE(status.error().message().find("does not move"), std::string::npos);
  }
  Jointed scene(1.0 / 60.0);
  const Entity tissue = scene.stage.add_soft(tets::box(2, 2, 2, dvec3(-0.01), dvec3(0.01)), pile_rubber(), Pose{});
  scene.join(of_kind(JointKind::kSlider), tissue, kNoEntity, dvec3(0));
  EXPECT_FALSE(prepare_world(scene.stage.world));
}

}  // namespace
}  // namespace pliant::test
