// Kinematic objects: motions against closed forms, poses and velocities against finite differences, hierarchies against
// matrices.
#include "systems/touch/prepare/move_objects.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/count_allocations.h"
#include "scenes/scenes.h"
#include "systems/touch/prepare/touch_state.h"

namespace pliant {
namespace {

using glm::dvec4;
using scenes::Stage;

constexpr double kPi = std::numbers::pi;

dvec4 as_values(const dquat& q) {
  return {q.x, q.y, q.z, q.w};
}
double angle_between(const dquat& a, const dquat& b) {
  return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}
// Quarter turns about an axis, as many as asked for, each `quarter` seconds long.
Track turning(dvec3 axis, double quarter, int quarters = 4) {
  Track track;
  for (int i = 0; i <= quarters; ++i) {
    track.times.push_back(quarter * i);
    track.values.push_back(as_values(glm::angleAxis(0.5 * kPi * i, axis)));
  }
  track.length = track.times.back();
  return track;
}
Track line(dvec3 from, dvec3 to, double seconds) {
  return {Interpolation::kLinear, {0.0, seconds}, {dvec4(from, 0), dvec4(to, 0)}, seconds};
}

TEST(Track, LinearKeysAreJoinedByStraightLinesAndHoldOutside) {
  const Track track{Interpolation::kLinear, {1, 2, 4}, {{0, 0, 0, 0}, {2, 4, 6, 0}, {-2, 0, 0, 0}}, 4};
  EXPECT_EQ(sample_vector(track, 0.0), dvec4(0));
  EXPECT_EQ(sample_vector(track, 1.5), dvec4(1, 2, 3, 0));
  EXPECT_EQ(sample_vector(track, 2.0), dvec4(2, 4, 6, 0));
  EXPECT_EQ(sample_vector(track, 3.0), dvec4(0, 2, 3, 0));
  EXPECT_EQ(sample_vector(track, 9.0), dvec4(-2, 0, 0, 0));
}

TEST(Track, StepsHoldUntilTheNextKey) {
  const Track track{Interpolation::kStep, {0, 1, 2}, {{1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}}, 2};
  for (const auto& [time, value] : {std::pair{0.0, 1.0}, {0.999, 1.0}, {1.0, 2.0}, {1.999, 2.0}, {2.0, 3.0}})
    EXPECT_EQ(sample_vector(track, time).x, value) << time;
}

TEST(Track, CubicSplinesAreExactForACubic) {
  const auto p = [](double t) { return dvec4(t * t * t - 2 * t, 1 + t * t, -t, 0); };
  const auto rate = [](double t) { return dvec4(3 * t * t - 2, 2 * t, -1, 0); };
  Track track{Interpolation::kCubicSpline, {0.0, 0.5, 2.0}, {}, 2.0};
  for (const double t : track.times)
    for (const dvec4& value : {rate(t), p(t), rate(t)}) track.values.push_back(value);
  for (double t = 0; t <= 2.0; t += 0.01) EXPECT_LT(length(sample_vector(track, t) - p(t)), 1e-13) << t;
}

TEST(Track, RotationsTurnAtAConstantRateTheShorterWayRound) {
  const dvec3 axis = normalize(dvec3(1, 2, -1));
  const Track track = turning(axis, 0.5);
  for (double t = 0; t <= 2.0; t += 0.013)
    EXPECT_LT(angle_between(sample_rotation(track, t), glm::angleAxis(kPi * t, axis)), 1e-7) << t;
  // The same rotation under the other sign of its quaternion.
  Track flipped = track;
  flipped.values[1] = -flipped.values[1];
  for (double t = 0; t <= 2.0; t += 0.013)
    EXPECT_LT(angle_between(sample_rotation(flipped, t), sample_rotation(track, t)), 1e-7) << t;
}

TEST(Track, ASplineOfRotationsStaysAUnitQuaternionAndPassesItsKeys) {
  const dquat a = glm::angleAxis(0.3, dvec3(0, 1, 0)), b = glm::angleAxis(1.9, normalize(dvec3(1, 1, 0)));
  const Track track{Interpolation::kCubicSpline,
                    {0, 2},
                    {dvec4(0), as_values(a), dvec4(0.4, 0, 0.1, 0), dvec4(0, 0.2, 0, 0.3), as_values(b), dvec4(0)},
                    2};
  for (double t = 0; t <= 2.0; t += 0.1) EXPECT_NEAR(glm::length(sample_rotation(track, t)), 1.0, 1e-12);
  EXPECT_LT(angle_between(sample_rotation(track, 0), a), 1e-7);
  EXPECT_LT(angle_between(sample_rotation(track, 2), b), 1e-7);
}

TEST(Motion, RepeatsOverItsLengthAtItsSpeedOrHolds) {
  PrescribedMotion motion;
  motion.translation = line({0, 0, 0}, {4, 0, 0}, 2.0);
  const auto x = [&](double t) { return sample_motion(motion, {}, t).translation.x; };
  EXPECT_NEAR(x(1.5), 3.0, 1e-12);
  EXPECT_NEAR(x(3.0), 2.0, 1e-12);
  EXPECT_NEAR(x(1e6 * 2.0 + 0.5), 1.0, 1e-8);
  EXPECT_TRUE(jumps_between(motion, 1.999, 2.001));
  EXPECT_FALSE(jumps_between(motion, 0.5, 0.501));
  motion.speed = 0.5;
  EXPECT_NEAR(x(3.0), 3.0, 1e-12);
  motion.repeats = false;
  EXPECT_NEAR(x(100.0), 4.0, 1e-12);
  EXPECT_FALSE(jumps_between(motion, 3.999, 4.001));
  PrescribedMotion closed;
  closed.rotation = turning({0, 1, 0}, 0.5);
  EXPECT_FALSE(jumps_between(closed, 1.999, 2.001)) << "a full turn ends as it began";
}

TEST(MoveObjects, PoseVelocityAndBoxOfATurningSphereAgreeWithFiniteDifferences) {
  Stage stage;
  const Entity ball = stage.add(scenes::sphere(8, 0.05), {}, Pose{{0.2, 0.1, 0}, {1, 0, 0, 0}});
  const dvec3 axis = normalize(dvec3(1, 3, 2));
  PrescribedMotion motion;
  motion.rotation = turning(axis, 0.25);
  motion.translation = line({0.2, 0.1, 0}, {0.3, 0.1, 0.4}, 10.0);
  stage.carry(ball, motion);
  stage.prepare();
  Pose before;
  for (int i = 0; i < 700; ++i) {
    before = stage.world.registry.get<Pose>(ball);
    stage.tick();
    if (i == 0) continue;
    const Pose pose = stage.world.registry.get<Pose>(ball);
    const double t = i * stage.dt();
    EXPECT_LT(length(pose.position - (dvec3(0.2, 0.1, 0) + t / 10.0 * dvec3(0.1, 0, 0.4))), 1e-7);
    EXPECT_LT(angle_between(pose.rotation, glm::angleAxis(2 * kPi * t, axis)), 1e-6);
    const MovingPose& moving = stage.world.registry.get<MovingPose>(ball);
    EXPECT_LT(length(moving.velocity - dvec3(0.01, 0, 0.04)), 1e-8);
    EXPECT_LT(length(moving.angular_velocity - 2 * kPi * axis), 1e-6);
    EXPECT_EQ(pose_before(stage.world.registry, ball).position, before.position);
    // A point that rides along is at rest on the surface.
    const dvec3 local(0.01, 0.03, -0.02), here = pose.to_world(local);
    const dvec3 velocity = surface_velocity(stage.world.registry, ball, here);
    EXPECT_LT(length(velocity - (here - before.to_world(local)) / stage.dt()), 1e-12);
    EXPECT_LT(length(velocity - moving.velocity - cross(moving.angular_velocity, here - pose.position)), 2e-3);
    const Box& box = stage.world.touch->objects[0].world_box;
    EXPECT_LT(length(dvec3(box.center()) - pose.position), 1e-6);
    EXPECT_GE(box.size().x, 0.0999f);
  }
}

TEST(MoveObjects, AChildGoesAroundWithItsTurningParentAndItsOwnMotionComesOnTop) {
  Stage stage;
  PrescribedMotion turn, own;
  turn.rotation = turning({0, 1, 0}, 0.25);
  own.rotation = turning({1, 0, 0}, 0.1);
  const Entity table = stage.add_node(turn, kNoEntity, {{1, 0, 0}, quat(1, 0, 0, 0), vec3(2)});
  const Entity ball = stage.add(scenes::sphere(4, 0.05), {}, Pose{{0.5, 0.25, 0}, {1, 0, 0, 0}});
  stage.carry(ball, own, table);
  stage.prepare();
  for (int i = 0; i < 300; ++i) stage.tick();
  const double t = 299 * stage.dt();
  const Pose& pose = stage.world.registry.get<Pose>(ball);
  const dquat turned = glm::angleAxis(2 * kPi * t, dvec3(0, 1, 0));
  EXPECT_LT(length(pose.position - (dvec3(1, 0, 0) + turned * (2.0 * dvec3(0.5, 0.25, 0)))), 1e-6);
  EXPECT_LT(angle_between(pose.rotation, turned * glm::angleAxis(5 * kPi * t, dvec3(1, 0, 0))), 1e-6);
  const MovingPose& moving = stage.world.registry.get<MovingPose>(ball);
  EXPECT_NEAR(length(moving.velocity), 2 * kPi * 1.0, 1e-3);
  EXPECT_LT(length(moving.angular_velocity - dvec3(0, 2 * kPi, 0) - turned * dvec3(5 * kPi, 0, 0)), 0.1);
}

TEST(MoveObjects, WhatJumpsAtTheEndOfALapHasNoVelocity) {
  Stage stage;
  const Entity ball = stage.add(scenes::sphere(4, 0.05), {});
  PrescribedMotion motion;
  motion.translation = line({0, 0, 0}, {1, 0, 0}, 0.1);
  stage.carry(ball, motion);
  stage.prepare();
  for (int i = 0; i < 350; ++i) {
    stage.tick();
    const MovingPose& moving = stage.world.registry.get<MovingPose>(ball);
    EXPECT_LT(length(moving.velocity), 10.0 + 1e-6) << i;
    EXPECT_GE(moving.velocity.x, -1e-6) << i;
  }
}

TEST(MoveObjects, WhatStandsStillCostsNothingAndHasNoMovingPose) {
  Stage stage;
  const Entity moving = stage.add(scenes::sphere(4, 0.05), {});
  const Entity still = stage.add(scenes::sphere(4, 0.05), {}, Pose{{1, 0, 0}, {1, 0, 0, 0}});
  PrescribedMotion motion;
  motion.rotation = turning({0, 1, 0}, 0.25);
  stage.carry(moving, motion);
  stage.add_node(motion);  // carries nothing
  stage.prepare();
  stage.tick();
  EXPECT_EQ(stage.world.touch->moving.size(), 1u);
  EXPECT_TRUE(stage.world.registry.has<MovingPose>(moving));
  EXPECT_FALSE(stage.world.registry.has<MovingPose>(still));
  EXPECT_EQ(pose_before(stage.world.registry, still).position, dvec3(1, 0, 0));
  EXPECT_EQ(surface_velocity(stage.world.registry, still, dvec3(1, 1, 1)), dvec3(0));
}

TEST(MoveObjects, ATickDoesNotAllocateAndTheSameMotionHasTheSameHash) {
  std::uint64_t hashes[3];
  for (int run = 0; run < 3; ++run) {
    Stage stage;
    const Entity ball = stage.add(scenes::sphere(4, 0.05), {});
    PrescribedMotion motion;
    motion.rotation = turning({0, 1, 0}, run < 2 ? 0.25 : 0.26);
    stage.carry(ball, motion);
    stage.prepare();
    stage.tick();
    {
      const CountAllocations allocations;
      for (int i = 0; i < 600; ++i) stage.tick();
      EXPECT_EQ(allocations.count(), 0u);
    }
    hashes[run] = stage.hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_NE(hashes[0], hashes[2]);
}

// A sheet rises against a hand that yields more slowly: its prescribed motion does work on the hand, which passivity
// relative to the world would not allow.
TEST(MoveObjects, ASurfaceThatComesMayPushAHandAway) {
  Stage stage;
  Deformable deformable;
  deformable.stiffness = 100;
  deformable.reach = 0.02;
  const Entity sheet = stage.add(scenes::sheet(40, 0.1), deformable);
  PrescribedMotion motion;
  motion.translation = {Interpolation::kLinear, {0.0, 0.5, 1.5}, {dvec4(0), dvec4(0), dvec4(0, 0.02, 0, 0)}, 1.5};
  motion.repeats = false;
  stage.carry(sheet, motion);
  const Entity probe = stage.add_probe({0, 0.005, 0});
  stage.prepare();
  stage.move(probe, {0, -0.001, 0}, 0.4);
  stage.wait(0.1);
  stage.move(probe, {0, 0.014, 0}, 1.0);
  const double wanted = length(stage.world.registry.get<Probe>(probe).force);
  EXPECT_NEAR(wanted, 100 * 0.006, 0.02);
  EXPECT_NEAR(length(stage.device(probe).force_sent), wanted, 1e-9);
}

// It does not matter which of the two moves.
TEST(MoveObjects, AProbeAtRestIsFoundByASurfaceThatComesToIt) {
  for (const double radius : {0.0, 0.004}) {
    Stage stage;
    Deformable deformable;
    deformable.stiffness = 200;
    deformable.reach = 0.02;
    deformable.friction_static = deformable.friction_sliding = 0.0;
    const Entity ball = stage.add(scenes::sphere(12, 0.05), deformable);
    PrescribedMotion motion;
    motion.translation = {Interpolation::kLinear, {0.0, 0.2, 0.6}, {dvec4(0), dvec4(0), dvec4(0, 0.02, 0, 0)}, 0.6};
    motion.repeats = false;
    stage.carry(ball, motion);
    const Entity probe = stage.add_probe({0, 0.065, 0}, radius);
    stage.prepare();
    stage.wait(0.7);
    EXPECT_NEAR(stage.world.registry.get<Probe>(probe).force.y, 200 * (0.005 + radius), 0.01) << radius;
  }
}

// A sheet has no thickness: it passes the probe between two ticks. Straight, and as a door that turns.
TEST(MoveObjects, AProbeAtRestIsFoundByASheetThatPassesItInATick) {
  for (const double radius : {0.0, 0.004})
    for (const double speed : {0.001, 0.01, 0.1, 1.0, 10.0}) {
      Stage stage;
      Deformable deformable;
      deformable.stiffness = 200;
      deformable.reach = 0.02;
      deformable.friction_static = deformable.friction_sliding = 0.0;
      const Entity sheet = stage.add(scenes::sheet(12, 0.1), deformable);
      PrescribedMotion motion;
      const double rise = 0.0153, duration = rise / speed;
      motion.translation = {Interpolation::kLinear, {0.0, duration}, {dvec4(0), dvec4(0, rise, 0, 0)}, duration};
      motion.repeats = false;
      stage.carry(sheet, motion);
      const Entity probe = stage.add_probe({0.003, 0.01 + radius, 0.002}, radius);
      stage.prepare();
      stage.wait(duration + 0.01);
      EXPECT_NEAR(stage.world.registry.get<Probe>(probe).force.y, 200 * 0.0053, 1e-4) << radius << ' ' << speed;
    }
  for (const double turns : {0.1, 1.0, 20.0}) {  // a second, up to 0.13 rad a tick
    Stage stage;
    Deformable deformable;
    deformable.stiffness = 200;
    deformable.reach = 0.02;
    deformable.friction_static = deformable.friction_sliding = 0.0;
    const Entity door = stage.add(scenes::sheet(12, 0.4), deformable);
    PrescribedMotion motion;
    motion.rotation = turning({0, 0, 1}, 0.25 / turns, 1);
    motion.repeats = false;
    stage.carry(door, motion);
    const double angle = 0.5 * kPi - 0.03;  // the door turns 0.03 rad past the probe
    const Entity probe = stage.add_probe(0.15 * dvec3(std::cos(angle), std::sin(angle), 0.1));
    stage.prepare();
    stage.wait(0.25 / turns + 0.01);
    EXPECT_NEAR(length(stage.world.registry.get<Probe>(probe).force), 200 * 0.15 * std::sin(0.03), 1e-4) << turns;
  }
}

// A probe that rides on a turning ball feels the same in the ball's frame, and no friction; one that stays is dragged.
TEST(MoveObjects, ContactAndFrictionGoWithATurningBall) {
  for (const bool rides : {true, false}) {
    Stage stage;
    Deformable deformable;
    deformable.stiffness = 300;
    deformable.reach = 0.03;
    deformable.friction_static = 0.5;
    deformable.friction_sliding = 0.4;
    const Entity ball = stage.add(scenes::sphere(20, 0.1), deformable);
    PrescribedMotion motion;
    motion.rotation = turning({0, 0, 1}, 1.0, 2);
    motion.repeats = false;
    stage.carry(ball, motion);
    const Entity probe = stage.add_probe({0, 0.101, 0});
    stage.prepare();
    for (int i = 0; i < 1500; ++i) {
      const double angle = 0.5 * kPi * i * 1e-3, r = i < 200 ? 0.101 - 4e-3 * i / 200 : 0.097;
      stage.place(probe, r * (rides ? dvec3(-std::sin(angle), std::cos(angle), 0) : dvec3(0, 1, 0)));
      stage.tick();
      if (i < 500) continue;
      const dvec3 f = stage.world.registry.get<Probe>(probe).force,
                  out = normalize(stage.world.registry.get<Probe>(probe).position);
      const dvec3 across = f - dot(f, out) * out;
      ASSERT_NEAR(dot(f, out), 0.9, 0.01) << rides << ' ' << i;
      ASSERT_NEAR(length(across), rides ? 0.0 : 0.4 * 0.9, 0.01) << rides << ' ' << i;
      if (!rides) ASSERT_GT(dot(across, cross(dvec3(0, 0, 1), out)), 0.0);  // along with the surface
    }
  }
}

}  // namespace
}  // namespace pliant
