// The force of a tool without weight compensation: its weight and moment, which are ramped up.
#include <gtest/gtest.h>

#include "scenes/scenes.h"
#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/safety/safety.h"
#include "systems/soft/body/rotation_vector.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

using scenes::ToolStage;

// A block of 30 mm whose lower half is tissue, with its handle 10 mm off its centre.
struct Held {
  ToolStage stage{1.0 / 60.0};
  Entity tool;
  dvec3 weight{0};  // [N]

  explicit Held(bool carried) {
    TetMesh mesh = tets::box(2, 3, 2, dvec3(0.01, 0, 0) - 0.015, dvec3(0.01, 0, 0) + 0.015);
    tets::hold(
        mesh, [](dvec3) { return false; }, [](dvec3 x) { return x.y > 1e-3; });
    SoftBody body;
    body.young = 1e5;
    body.density = 2000.0;
    body.rayleigh = {1.0, 0.01};
    Handle6 handle;
    handle.carried = carried;
    tool = stage.add_soft(mesh, body, Pose{}, &handle);
    stage.device_of(tool).max_force = 3.3;
    stage.prepare();
    for (const double m : stage.tissue(tool).tissue().mass()) weight += m * stage.world.simulation.gravity;
  }
  dvec3 force() { return stage.device_of(tool).force_sent; }
  dvec3 torque() { return stage.device_of(tool).torque_sent; }
};

TEST(Weight, OfAToolThatNothingCarriesIsFeltAndComesInAgainAfterALoss) {
  Held held(false);
  ASSERT_GT(length(held.weight), 2 * kEngageForce);
  const auto expect_all_of_it = [&] {
    EXPECT_LT(length(held.force() - held.weight), 0.01 * length(held.weight));
    const dvec3 moment = cross(dvec3(0.01, 0, 0), held.weight);
    EXPECT_LT(length(held.torque() - moment), 0.05 * length(moment));
  };
  held.stage.lead(held.tool, dvec3(0), 2.0);
  expect_all_of_it();

  held.stage.device_of(held.tool).status = DeviceStatus::kLost;
  held.stage.lead(held.tool, dvec3(0), 0.1, [&] { EXPECT_EQ(held.force(), dvec3(0)); });
  held.stage.device_of(held.tool).status = DeviceStatus::kReady;
  dvec3 last(0);
  double most_change = 0.0;
  held.stage.lead(held.tool, dvec3(0), 2.0, [&] {
    most_change = std::max(most_change, length(held.force() - last));
    last = held.force();
  });
  EXPECT_LT(most_change, 0.01) << "it comes in over hundreds of ticks";
  expect_all_of_it();
}

// Tissue starts in equilibrium: nothing falls, and no energy reaches the hand.
TEST(Weight, OfTissueHangsFromTheBeginning) {
  Held held(true);
  const std::vector<dvec3> first = held.stage.tissue(held.tool).tissue().position();
  double most = 0.0, sag = 0.0;
  held.stage.lead(held.tool, dvec3(0), 0.3, [&] { most = std::max(most, length(held.force())); });
  const Tissue& tissue = held.stage.tissue(held.tool).tissue();
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_LT(length(tissue.position()[i] - first[i]), 1e-7);
    sag = std::max(sag, -first[i].y - 0.015);
  }
  EXPECT_LT(most, 1e-4 * length(held.weight));
  EXPECT_GT(sag, 1e-6) << "the lowest nodes are lower than at rest";
}

// If it would sag into an object below, it starts above that and falls on it.
TEST(Weight, OfTissueThatWouldHangThroughAFloorFallsOnItInstead) {
  for (const double gap : {1e-5, 0.05}) {
    ToolStage stage(1.0 / 60.0);
    TetMesh mesh = tets::box(3, 1, 1, dvec3(-0.03, -0.004, -0.005), dvec3(0.03, 0.004, 0.005));
    tets::hold(
        mesh, [](dvec3) { return false; }, [](dvec3 x) { return x.x < -0.02; });
    SoftBody body;
    body.young = 1e5;
    body.density = 1000.0;
    body.rayleigh = {1.0, 0.01};
    const Handle6 handle;
    const Entity tool = stage.add_soft(mesh, body, Pose{}, &handle);
    RigidBody floor;
    floor.fixed = true;
    stage.add_rigid(scenes::sheet(4, 0.2), floor, Pose{{0, -0.004 - gap, 0}});
    stage.prepare();
    const std::vector<dvec3>& collision_mesh = stage.tissue(tool).surface_position;
    const auto lowest = [&] {
      double y = 1.0;
      for (const dvec3& x : collision_mesh) y = std::min(y, x.y);
      return y;
    };
    if (gap > 1e-3)
      EXPECT_LT(lowest(), -0.00405) << "it hangs freely";
    else
      EXPECT_NEAR(lowest(), -0.004, 1e-9);
    stage.lead(tool, dvec3(0), 0.5);
    EXPECT_GT(lowest(), -0.004 - gap - 1e-4);
  }
}

TEST(Weight, IsFeltOnTheWayDownAsOnTheWayUp) {
  Held held(false);
  held.stage.lead(held.tool, dvec3(0), 2.0);
  for (const double height : {-0.1, 0.05}) {
    held.stage.lead(held.tool, dvec3(0, height, 0), 1.0);
    held.stage.lead(held.tool, dvec3(0, height, 0), 1.0);
    held.stage.lead(held.tool, dvec3(0, height, 0), 0.3,
                    [&] { EXPECT_LT(length(held.force() - held.weight), 0.1 * length(held.weight)) << height; });
  }
  double least = 10.0;
  held.stage.lead(held.tool, dvec3(0, -0.2, 0), 5.0, [&] { least = std::min(least, -held.force().y); });
  EXPECT_GT(least, 0.5 * length(held.weight));
}

TEST(Weight, OfACarriedToolIsNotFelt) {
  Held held(true);
  held.stage.lead(held.tool, dvec3(0), 2.0, [&] { EXPECT_LT(length(held.force()), 0.01); });
}

}  // namespace
}  // namespace pliant
