// Tools whose rigid part touches rigid objects: a fixed body, another tool's rigid part, a rigid object between the
// two. Oracle: at rest the hand feels only its coupling, F_max tanh(k d / F_max) for the distance d between device and
// handle.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/device/devices.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

using scenes::ToolStage;

constexpr double kFrontStep = 1.0 / 60.0;  // [s]
constexpr double kSlew = 100.0;            // [N/s] of the devices

// A block of 30 mm, which is rigid below y = 1 mm of its own frame or above it.
enum class Rigid : std::uint8_t { kFront, kBack, kAll };
TetMesh block(Rigid rigid) {
  TetMesh mesh = tets::box(2, 3, 2, dvec3(-0.015), dvec3(0.015));
  tets::hold(
      mesh, [](dvec3) { return false; },
      [rigid](dvec3 x) { return rigid == Rigid::kAll || (rigid == Rigid::kFront ? x.y < 1e-3 : x.y > 1e-3); });
  return mesh;
}

SoftBody tissue(double young = 2e4) {
  SoftBody body;
  body.young = young;
  body.poisson = 0.3;
  body.density = 200.0;
  body.rayleigh = {1.0, 0.01};
  return body;
}

// Observed force of a tool: the maximum, and the largest rise in a tick.
struct Watch {
  Entity tool;
  double most_force = 0.0, most_rise = 0.0;  // [N]
  dvec3 before{0};
  bool started = false;
  void look(ToolStage& stage) {
    const dvec3 force = stage.device_of(tool).force_sent;
    if (started) most_rise = std::max(most_rise, length(force) - length(before));
    most_force = std::max(most_force, length(force));
    before = force;
    started = true;
  }
};

Entity add_tool(ToolStage& stage, Rigid rigid, Pose pose, double young = 2e4) {
  const Handle6 handle;
  const Entity tool = stage.add_soft(block(rigid), tissue(young), pose, &handle);
  stage.device_of(tool).max_force = 3.3;
  stage.device_of(tool).max_slew = kSlew;
  return tool;
}

ToolTouchState& front_state(ToolStage& stage, Entity tool) {
  for (const auto& candidate : stage.world.tools->tools)
    if (candidate->entity == tool) return *candidate;
  std::abort();
}

// [m] along y, from the handle to where the device wants it.
double behind(ToolStage& stage, Entity tool) {
  const ToolTouchState& state = front_state(stage, tool);
  return (state.sensed.at(state.model.read().centre).pose.position - state.handle.pose.position).y;
}

double coupling_law(double stretch) {
  const Handle6 handle;
  return handle.max_force * std::tanh(handle.translation[0] * stretch / handle.max_force);
}

void add_front_floor(ToolStage& stage) {
  RigidBody floor;
  floor.fixed = true;
  stage.add_rigid(scenes::box(dvec3(0.2, 0.02, 0.2)), floor, Pose{dvec3(0, -0.01, 0), {1, 0, 0, 0}});
}

// A tool pressed `depth` [m] into a fixed floor in `way` [s] and kept there.
void expect_the_coupling_is_felt_on_a_floor(Rigid rigid, double young, double depth, double way = 0.3) {
  SCOPED_TRACE(testing::Message() << "young " << young << ", depth " << depth);
  ToolStage stage(kFrontStep);
  stage.world.simulation.gravity = dvec3(0);
  add_front_floor(stage);
  Watch watch{add_tool(stage, rigid, Pose{dvec3(0, 0.02, 0), {1, 0, 0, 0}}, young)};
  stage.prepare();
  double deepest = 0.0;
  const auto look = [&] {
    watch.look(stage);
    if (front_state(stage, watch.tool).placed())
      deepest = std::max(deepest, 0.015 - (stage.device_of(watch.tool).position.y - behind(stage, watch.tool)));
  };
  stage.lead(watch.tool, dvec3(0, 0.02, 0), 0.1, look);
  stage.lead(watch.tool, dvec3(0, 0.015 - depth, 0), way, look);
  stage.lead(watch.tool, dvec3(0, 0.015 - depth, 0), 0.5, look);

  const dvec3 force = stage.device_of(watch.tool).force_sent;
  EXPECT_NEAR(force.y, coupling_law(depth), 0.01 * coupling_law(depth));
  EXPECT_LT(length(force - dvec3(0, force.y, 0)), 0.01 * force.y);
  const double speed = (depth + 5e-3) / way;
  EXPECT_LT(deepest, speed * (kFrontStep + stage.dt())) << "the way until a soft step sees the floor";
  EXPECT_LT(std::abs(behind(stage, watch.tool) + depth), 2e-5) << "then it is brought back";
  EXPECT_LE(watch.most_rise, kSlew * stage.dt() * (1 + 1e-9));
  EXPECT_LT(watch.most_force, 1.01 * (coupling_law(depth) + Handle6{}.translation[1] * speed)) << "spring and damper";

  stage.lead(watch.tool, dvec3(0, 0.03, 0), 0.3, look);
  stage.lead(watch.tool, dvec3(0, 0.03, 0), 0.3, look);
  EXPECT_LT(length(stage.device_of(watch.tool).force_sent), 0.01) << "nothing holds it back";
}

TEST(RigidFront, OnAFixedFloorTheCouplingAloneIsFelt) {
  expect_the_coupling_is_felt_on_a_floor(Rigid::kFront, 2e4, 3e-3);
  expect_the_coupling_is_felt_on_a_floor(Rigid::kFront, 2e4, 15e-3);
  expect_the_coupling_is_felt_on_a_floor(Rigid::kFront, 2e4, 3e-3, 0.06);
  expect_the_coupling_is_felt_on_a_floor(Rigid::kAll, 2e4, 3e-3);
}

TEST(RigidFront, TissueAsHardAsStoneIsOne) {
  for (const double young : {1e8, 1e9, 1e10, 1e12}) expect_the_coupling_is_felt_on_a_floor(Rigid::kBack, young, 3e-3);
}

TEST(RigidFront, TwoToolsPressedTogetherFeelTheirCouplings) {
  ToolStage stage(kFrontStep);
  stage.world.simulation.gravity = dvec3(0);
  const dquat turned(0, 0, 0, 1);  // about z: its front upwards
  Watch above{add_tool(stage, Rigid::kFront, Pose{dvec3(0, 0.02, 0), {1, 0, 0, 0}})};
  Watch below{add_tool(stage, Rigid::kFront, Pose{dvec3(0.003, -0.02, 0.002), turned})};
  stage.prepare();
  const auto look = [&] { above.look(stage), below.look(stage); };
  stage.lead(above.tool, dvec3(0, 0.02, 0), 0.1, look);
  stage.lead(above.tool, dvec3(0, 0.012, 0), 0.3, look);
  stage.lead(below.tool, dvec3(0.003, -0.012, 0.002), 0.3, look);
  stage.lead(above.tool, dvec3(0, 0.012, 0), 1.0, look);
  // 6 mm too near: the sum of the distances of the two handles from their devices.
  const double above_stretch = -behind(stage, above.tool), below_stretch = behind(stage, below.tool);
  EXPECT_NEAR(above_stretch + below_stretch, 6e-3, 5e-4);
  EXPECT_NEAR(linear(front_state(stage, above.tool).device_wrench).y, coupling_law(above_stretch), 1e-3);
  EXPECT_NEAR(linear(front_state(stage, below.tool).device_wrench).y, -coupling_law(below_stretch), 1e-3);
  for (const Watch& watch : {above, below}) {
    EXPECT_LE(watch.most_rise, kSlew * stage.dt() * (1 + 1e-9));
    EXPECT_LT(watch.most_force, 1.01 * (coupling_law(6e-3) + Handle6{}.translation[1] * 8e-3 / 0.3));
  }
}

// Dragged along the floor, the rigid front slides with Coulomb friction, once the handle has reached its speed.
TEST(RigidFront, SlidesWithCoulombsFriction) {
  ToolStage stage(kFrontStep);
  stage.world.simulation.gravity = dvec3(0);
  add_front_floor(stage);
  const Entity tool = add_tool(stage, Rigid::kFront, Pose{dvec3(-0.03, 0.02, 0), {1, 0, 0, 0}});
  stage.prepare();
  stage.lead(tool, dvec3(-0.03, 0.012, 0), 0.4);
  stage.lead(tool, dvec3(0.0, 0.012, 0), 1.0);
  double normal = 0.0, tangential = 0.0;
  stage.lead(tool, dvec3(0.009, 0.012, 0), 0.3, [&] {
    normal += linear(front_state(stage, tool).device_wrench).y;
    tangential -= linear(front_state(stage, tool).device_wrench).x;
  });
  EXPECT_NEAR(normal / 300, coupling_law(3e-3), 0.01 * coupling_law(3e-3));
  EXPECT_NEAR(tangential / normal, SoftBody{}.friction_sliding, 0.02);
}

// A rigid box between a rigid tool and the floor is immovable.
TEST(RigidFront, ARigidBoxOnTheFloorIsAsGoodAsTheFloor) {
  ToolStage stage(kFrontStep);
  add_front_floor(stage);
  RigidBody body;
  body.density = 500.0;
  const Entity between = stage.add_rigid(scenes::box(dvec3(0.04)), body, Pose{dvec3(0, 0.0201, 0), {1, 0, 0, 0}});
  Watch watch{add_tool(stage, Rigid::kFront, Pose{dvec3(0, 0.06, 0), {1, 0, 0, 0}})};
  stage.prepare();
  const auto look = [&] { watch.look(stage); };
  stage.lead(watch.tool, dvec3(0, 0.06, 0), 0.3, look);
  stage.lead(watch.tool, dvec3(0, 0.052, 0), 0.3, look);
  stage.lead(watch.tool, dvec3(0, 0.052, 0), 0.7, look);
  EXPECT_NEAR(linear(front_state(stage, watch.tool).device_wrench).y, coupling_law(3e-3), 0.02);
  EXPECT_LE(watch.most_rise, kSlew * stage.dt() * (1 + 1e-9));
  EXPECT_LT(watch.most_force, 1.1 * coupling_law(3e-3));
  for (const dvec3& x : stage.body(between).surface_position)
    EXPECT_TRUE(x.y > -1e-4 && x.y < 0.0401) << "it is neither pressed in nor thrown up: " << x.y;
}

}  // namespace
}  // namespace pliant
