// A rigid body with a handle: an instrument. Oracles: the coupling's law F_max tanh(k d / F_max) against rigid objects,
// an equivalent tool of fully rigid tissue, the instrument's weight, action and reaction.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

using scenes::ToolStage;

constexpr double kRigidToolStep = 1.0 / 60.0;  // [s]
constexpr double kHalf = 0.015;                // [m] half the side of every block

Pose pose_at(dvec3 x) {
  return {x, {1, 0, 0, 0}};
}

ToolTouchState& state_of(ToolStage& stage, Entity tool) {
  for (const auto& candidate : stage.world.tools->tools)
    if (candidate->entity == tool) return *candidate;
  std::abort();
}

dvec3 felt(ToolStage& stage, Entity tool) {
  return linear(state_of(stage, tool).device_wrench);
}

double law(const Handle6& handle, double stretch) {
  return handle.max_force * std::tanh(handle.translation[0] * stretch / handle.max_force);
}

Entity add_instrument(ToolStage& stage, Pose pose, Handle6 handle = {}) {
  RigidBody body;
  body.density = 800.0;
  return stage.add_rigid(scenes::box(dvec3(2 * kHalf)), body, pose, &handle);
}

void add_floor(ToolStage& stage) {
  RigidBody floor;
  floor.fixed = true;
  stage.add_rigid(scenes::box(dvec3(0.2, 0.02, 0.2)), floor, pose_at({0, -0.01, 0}));
}

TEST(RigidTool, CarriedItIsNotFeltAndElseWeighsWhatItWeighs) {
  for (const bool carried : {true, false}) {
    ToolStage stage(kRigidToolStep);
    Handle6 handle;
    handle.carried = carried;
    const Entity tool = add_instrument(stage, pose_at({0, 0.1, 0}), handle);
    stage.prepare();
    stage.lead(tool, dvec3(0, 0.1, 0), 1.5);
    const double weight = carried ? 0.0 : 800.0 * std::pow(2 * kHalf, 3) * stage.world.simulation.gravity.y;
    EXPECT_NEAR(felt(stage, tool).y, weight, 1e-6 + 1e-3 * std::abs(weight)) << carried;
  }
}

TEST(RigidTool, OnAFloorItsCouplingIsFelt) {
  for (const double depth : {1e-3, 3e-3, 15e-3})
    for (const double way : {0.3, 0.05, 0.02}) {
      SCOPED_TRACE(testing::Message() << depth << " m in " << way << " s");
      ToolStage stage(kRigidToolStep);
      add_floor(stage);
      const Entity tool = add_instrument(stage, pose_at({0, 0.02, 0}));
      stage.prepare();
      stage.lead(tool, dvec3(0, 0.02, 0), 0.1);
      stage.lead(tool, dvec3(0, kHalf - depth, 0), way);
      stage.lead(tool, dvec3(0, kHalf - depth, 0), 0.6);
      EXPECT_NEAR(felt(stage, tool).y, law({}, depth), 0.01 * law({}, depth));
      EXPECT_LT(length(dvec2(felt(stage, tool).x, felt(stage, tool).z)), 0.01 * law({}, depth));
      stage.lead(tool, dvec3(0, 0.03, 0), 0.3);
      stage.lead(tool, dvec3(0, 0.03, 0), 0.3);
      EXPECT_LT(length(felt(stage, tool)), 1e-3) << "nothing holds it back";
    }
}

// A rigid cube between the instrument and the floor, for any speed of the hand.
TEST(RigidTool, ThroughARigidCubeOnTheFloorItsCouplingIsFelt) {
  for (const double speed : {0.02, 0.04, 0.1, 0.3, 1.0}) {
    SCOPED_TRACE(speed);
    ToolStage stage(kRigidToolStep);
    add_floor(stage);
    RigidBody cube;
    cube.density = 500.0;
    const Entity between = stage.add_rigid(scenes::box(dvec3(0.03)), cube, pose_at({0, 0.01501, 0}));
    const Entity tool = add_instrument(stage, pose_at({0, 0.055, 0}));
    stage.prepare();
    stage.lead(tool, dvec3(0, 0.055, 0), 0.2);
    stage.lead(tool, dvec3(0, 0.045 - 0.01, 0), 0.02 / speed);
    stage.lead(tool, dvec3(0, 0.045 - 0.01, 0), 1.0);
    EXPECT_NEAR(felt(stage, tool).y, law({}, 0.01), 0.02 * law({}, 0.01));
    for (const dvec3& x : stage.body(between).surface_position)
      EXPECT_TRUE(x.y > -3e-4 && x.y < 0.0303) << "neither pressed in nor thrown up: " << x.y;
  }
}

// Pressed obliquely, within the friction cone: nothing creeps, and the new models at 60 Hz cause no perceptible change.
TEST(RigidTool, OnATowerTheForceIsStillForAsLongAsItIsHeld) {
  ToolStage stage(kRigidToolStep);
  add_floor(stage);
  RigidBody box;
  box.density = 500.0;
  constexpr int kBoxes = 4;
  for (int i = 0; i < kBoxes; ++i)
    stage.add_rigid(scenes::box(dvec3(0.03)), box,
                    {dvec3(0, 0.01501 + 0.03002 * i, 0), rotation_of(dvec3(0, 0.07 * i, 0))});
  const double top = 0.03002 * kBoxes;
  const dquat askew = rotation_of(dvec3(0.35, 0.0, 0.0));
  const Entity tool = add_instrument(stage, {dvec3(0, top + 0.04, 0), askew});
  stage.prepare();
  stage.device_of(tool).rotation = askew;
  stage.lead(tool, dvec3(0, top + 0.04, 0), 0.2);
  stage.lead(tool, dvec3(0.0005, top + 0.015, 0.001), 0.5);
  stage.lead(tool, dvec3(0.0005, top + 0.015, 0.001), 2.0);
  const dvec3 before = felt(stage, tool);
  double noise = 0.0;
  stage.lead(tool, dvec3(0.0005, top + 0.015, 0.001), 4.0,
             [&] { noise = std::max(noise, length(felt(stage, tool) - before)); });
  EXPECT_GT(before.y, 0.5) << "it is pressed on";
  EXPECT_LT(noise, 60e-6 * 4.0) << "[N] and as much a second at most";
}

// The same instrument as tetrahedra that all belong to the handle.
TEST(RigidTool, FeelsAsAToolOfTissueThatIsRigidAllThrough) {
  const auto forces = [](bool tetrahedra) {
    ToolStage stage(kRigidToolStep);
    SoftBody soft;
    soft.young = 2e4;
    soft.poisson = 0.3;
    soft.rayleigh = {1.0, 0.01};
    TetMesh organ = tets::box(6, 3, 6, dvec3(-0.03, -0.015, -0.03), dvec3(0.03, 0.015, 0.03));
    tets::hold(
        organ, [](dvec3 x) { return x.y < -0.0149; }, [](dvec3) { return false; });
    stage.add_soft(std::move(organ), soft, pose_at({0, 0, 0}));
    Handle6 handle;
    TetMesh block = tets::box(2, 2, 2, dvec3(-kHalf), dvec3(kHalf));
    tets::hold(
        block, [](dvec3) { return false; }, [](dvec3) { return true; });
    SoftBody mass;
    mass.density = 800.0;
    // Lumped masses make the twin heavier to turn; straight down on the organ's middle nothing turns.
    RigidBody rigid;
    rigid.density = 800.0;
    const Entity tool = tetrahedra ? stage.add_soft(block, mass, pose_at({0, 0.035, 0}), &handle)
                                   : stage.add_rigid(scenes::border(block), rigid, pose_at({0, 0.035, 0}), &handle);
    stage.prepare();
    std::vector<double> out;
    const auto note = [&] { out.push_back(felt(stage, tool).y); };
    stage.lead(tool, dvec3(0, 0.035, 0), 0.1, note);
    stage.lead(tool, dvec3(0, 0.022, 0), 0.3, note);
    stage.lead(tool, dvec3(0, 0.022, 0), 0.3, note);
    stage.lead(tool, dvec3(0, 0.035, 0), 0.2, note);
    return out;
  };
  const std::vector<double> twin = forces(true), rigid = forces(false);
  const double most = *std::max_element(twin.begin(), twin.end());
  ASSERT_GT(most, 0.5);
  for (std::size_t i = 0; i < twin.size(); ++i) EXPECT_NEAR(rigid[i], twin[i], 0.02 * most) << i;
}

// Two hands, one with a coupling three times as stiff: both feel the same force.
TEST(RigidTool, TwoInstrumentsPressOnEachOther) {
  ToolStage stage(kRigidToolStep);
  stage.world.simulation.gravity = dvec3(0);
  Handle6 soft, stiff;
  stiff.translation = {600.0, 4.0};
  const Entity above = add_instrument(stage, pose_at({0, 0.02, 0}), soft);
  const Entity below = add_instrument(stage, pose_at({0.002, -0.02, 0.001}), stiff);
  stage.prepare();
  stage.lead(above, dvec3(0, 0.02, 0), 0.1);
  stage.lead(above, dvec3(0, 0.012, 0), 0.2);
  stage.lead(below, dvec3(0.002, -0.012, 0.001), 0.2);
  stage.lead(above, dvec3(0, 0.012, 0), 1.5);
  const double up = felt(stage, above).y, down = felt(stage, below).y;
  EXPECT_GT(up, 0.3);
  EXPECT_NEAR(up, -down, 0.02 * up) << "action and reaction";
  // 6 mm too near between two springs in series.
  const auto stretch = [&](double force, const Handle6& h) {
    return h.max_force / h.translation[0] * std::atanh(std::abs(force) / h.max_force);
  };
  EXPECT_NEAR(stretch(up, soft) + stretch(down, stiff), 6e-3, 3e-4);
  // The one that presses harder moves the other.
  stage.lead(above, dvec3(0, 0.008, 0), 0.2);
  stage.lead(above, dvec3(0, 0.008, 0), 1.5);
  EXPECT_GT(felt(stage, above).y, 1.3 * up);
  EXPECT_NEAR(felt(stage, above).y, -felt(stage, below).y, 0.02 * felt(stage, above).y);
}

// Two instruments close on a soft cube from both sides, at any speed: it stays between them, they feel the same, and
// together they carry its weight.
TEST(RigidTool, TwoInstrumentsPinchASoftCubeAtAnySpeed) {
  for (const double speed : {0.01, 0.1, 1.0}) {
    SCOPED_TRACE(speed);
    ToolStage stage(kRigidToolStep);
    add_floor(stage);
    SoftBody soft;
    soft.young = 2e4;
    soft.poisson = 0.4;
    soft.density = 500.0;
    soft.rayleigh = {1.0, 0.01};
    soft.friction_static = 0.8, soft.friction_sliding = 0.7;
    const Entity cube =
        stage.add_soft(tets::box(3, 3, 3, dvec3(-kHalf), dvec3(kHalf)), soft, pose_at({0, kHalf + 1e-5, 0}));
    const double away = 0.04, near = 2 * kHalf - 0.004, height = kHalf + 0.001;
    const Entity left = add_instrument(stage, pose_at({-away, height, 0})),
                 right = add_instrument(stage, pose_at({away, height, 0}));
    stage.prepare();
    const auto both = [&](double x, double y, double seconds) {
      const dvec3 from = stage.device_of(right).position;
      const int ticks = std::max(1, static_cast<int>(std::lround(seconds / stage.dt())));
      for (int i = 1; i <= ticks; ++i) {
        const dvec3 to = from + double(i) / ticks * (dvec3(x, y, 0) - from);
        stage.device_of(right).position = to;
        stage.device_of(left).position = dvec3(-to.x, to.y, 0);
        stage.run(stage.dt());
      }
    };
    both(away, height, 0.2);
    both(near, height, (away - near) / speed);
    both(near, height, 0.5);
    both(near, height + 0.03, 0.03 / std::min(speed, 0.3));
    both(near, height + 0.03, 1.5);
    double lowest = 1e300;
    for (const dvec3& x : stage.body(cube).surface_position) lowest = std::min(lowest, x.y);
    EXPECT_GT(lowest, 0.02) << "it hangs between the two";
    const dvec3 of_left = felt(stage, left), of_right = felt(stage, right);
    EXPECT_GT(of_right.x, 0.2);
    EXPECT_NEAR(of_right.x, -of_left.x, 0.02 * of_right.x);
    const double weight = 500.0 * std::pow(2 * kHalf, 3) * 9.81;
    EXPECT_NEAR(of_left.y + of_right.y, -weight, 0.03 * weight);
    EXPECT_LT(stage.soft().tally.deepest, 1e-3);
  }
}

// Farther from its device than a hand can reach: no force meanwhile, then it is reset to the device.
TEST(RigidTool, WhatGetsAwayIsSetBackIntoTheHand) {
  ToolStage stage(kRigidToolStep);
  const Entity tool = add_instrument(stage, pose_at({0, 0.1, 0}));
  stage.prepare();
  stage.lead(tool, dvec3(0, 0.1, 0), 0.2);
  EXPECT_EQ((stage.world.dropped | stage.soft().dropped) & kDroppedSetBack, 0u);
  stage.device_of(tool).position = dvec3(5, 0.1, 0);
  double most = 0.0;
  stage.lead(tool, dvec3(5, 0.1, 0), 0.3, [&] { most = std::max(most, length(stage.device_of(tool).force_sent)); });
  EXPECT_NE(stage.world.dropped & kDroppedSetBack, 0u);
  EXPECT_NE(stage.world.dropped & kDroppedJump, 0u);
  EXPECT_LT(length(state_of(stage, tool).handle.pose.position - dvec3(5, 0.1, 0)), 1e-3);
  EXPECT_LT(length(stage.body(tool).surface_position.front() - dvec3(5, 0.1, 0)), 0.03);
  EXPECT_LT(most, 0.2) << "[N] below what opens the gate";
  // And it works as before.
  stage.lead(tool, dvec3(5.01, 0.1, 0), 0.1);
  stage.lead(tool, dvec3(5.01, 0.1, 0), 0.3);
  EXPECT_LT(length(state_of(stage, tool).handle.pose.position - dvec3(5.01, 0.1, 0)), 1e-3);
}

}  // namespace
}  // namespace pliant
