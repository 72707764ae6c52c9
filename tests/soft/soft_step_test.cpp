#include "systems/soft/soft_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/soft/body/rigid_state.h"
#include "systems/soft/body/soft_body_state.h"
#include "systems/soft/prepare_soft.h"
#include "systems/tool/prepare_tools.h"
#include "systems/touch/prepare/prepare.h"

namespace pliant {
namespace {

using scenes::ToolStage;

constexpr double kSoftStepLength = 1.0 / 60.0;  // [s]
constexpr double kEdge = 0.04;                  // [m] of the cubes

TetMesh cube(int cells, double edge = kEdge) {
  return tets::box(cells, cells, cells, dvec3(-0.5 * edge), dvec3(0.5 * edge));
}

SoftBody rubber() {
  SoftBody body;
  body.young = 3e4;
  body.poisson = 0.4;
  body.rayleigh = {1.0, 0.01};
  return body;
}

RigidBody ground() {
  RigidBody body;
  body.fixed = true;
  return body;
}
const dvec3 kGroundSize(0.3, 0.02, 0.3);
Primitive ground_box() {
  return scenes::box(kGroundSize, dvec3(0, -0.5 * kGroundSize.y, 0));  // its top is y = 0
}

double weight(ToolStage& stage, Entity soft) {
  double mass = 0.0;
  for (const double m : stage.tissue(soft).tissue().mass()) mass += m;
  return mass * 9.81;
}

TEST(PrepareSoft, ALevelWithoutSoftOrRigidBodiesHasNoSoftClock) {
  ToolStage stage(kSoftStepLength);
  stage.add(scenes::sheet(8, 0.1), {});
  stage.add_rigid(ground_box(), ground(), {});
  stage.prepare();
  EXPECT_EQ(stage.world.soft, nullptr);
  EXPECT_EQ(stage.world.soft_snapshots, nullptr);
  stage.step();  // does nothing, and does not fall over
}

TEST(PrepareSoft, ARigidBodyThatEnclosesNothingIsRefusedByName) {
  ToolStage stage(kSoftStepLength);
  stage.add_rigid(scenes::sheet(2, 0.1), {}, {});
  ASSERT_TRUE(prepare_touch(stage.world).ok());
  ASSERT_TRUE(prepare_tools(stage.world).ok());
  const Status status = prepare_soft(stage.world);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message().find("rigid"), std::string::npos);
  EXPECT_NE(status.error().message().find("fixed"), std::string::npos);
}

TEST(PrepareSoft, ASoftStepThatIsNoDurationIsRefused) {
  for (const double T : {0.0, -1.0, 2.0, std::nan("")}) {
    ToolStage stage(T);
    stage.add_rigid(scenes::box(dvec3(0.1)), {}, {});
    ASSERT_TRUE(prepare_touch(stage.world).ok());
    ASSERT_TRUE(prepare_tools(stage.world).ok());
    EXPECT_FALSE(prepare_soft(stage.world).ok()) << T;
  }
}

TEST(SoftStep, ASoftCubeFallsAndRestsWithItsWeightOnTheGround) {
  ToolStage stage(kSoftStepLength);
  const Entity soft = stage.add_soft(cube(3), rubber(), {dvec3(0, 0.5 * kEdge + 0.01, 0)});
  const Entity floor = stage.add_rigid(ground_box(), ground(), {});
  stage.prepare();
  for (int i = 0; i < 120; ++i) stage.step();
  const dvec3 force = stage.contact_force(soft, floor);
  EXPECT_NEAR(force.y, weight(stage, soft), 0.01 * weight(stage, soft));
  EXPECT_LT(std::hypot(force.x, force.z), 0.01 * weight(stage, soft));
  EXPECT_LT(stage.kinetic_energy(), 1e-9);
  EXPECT_EQ(stage.soft().dropped, 0u);
}

TEST(SoftStep, TheLowerOfTwoSoftCubesCarriesBoth) {
  ToolStage stage(kSoftStepLength);
  const Entity lower = stage.add_soft(cube(2), rubber(), {dvec3(0, 0.5 * kEdge + 0.001, 0)});
  const Entity upper = stage.add_soft(cube(2, 0.03), rubber(), {dvec3(0.002, kEdge + 0.5 * 0.03 + 0.003, 0.001)});
  const Entity floor = stage.add_rigid(ground_box(), ground(), {});
  stage.prepare();
  for (int i = 0; i < 180; ++i) stage.step();
  const double both = weight(stage, lower) + weight(stage, upper);
  EXPECT_NEAR(stage.contact_force(upper, lower).y, weight(stage, upper), 0.01 * weight(stage, upper));
  EXPECT_NEAR(stage.contact_force(lower, floor).y, both, 0.01 * both);
}

// Two rigid fingers of a scripted gripper with a soft cube between them.
struct GripOfBar {
  explicit GripOfBar(double friction, double step = kSoftStepLength) : stage(step) {
    SoftBody body = rubber();
    body.friction_static = body.friction_sliding = friction;
    soft = stage.add_soft(cube(2), body, {});
    RigidBody finger = ground();
    finger.friction_static = finger.friction_sliding = friction;
    const dvec3 size(0.01, 0.05, 0.05);
    left = stage.add_rigid(scenes::box(size), finger, {dvec3(-0.5 * (kEdge + size.x) - 1e-3, 0, 0)});
    right = stage.add_rigid(scenes::box(size), finger, {dvec3(0.5 * (kEdge + size.x) + 1e-3, 0, 0)});
  }
  void move(dvec3 of_left, dvec3 of_right, double seconds) {
    dynamic_cast<FixedBody&>(stage.body(left)).set_velocity(of_left, dvec3(0));
    dynamic_cast<FixedBody&>(stage.body(right)).set_velocity(of_right, dvec3(0));
    for (int i = 0; i < std::lround(seconds / stage.soft_step()); ++i) stage.step();
  }
  double height() {  // [m] of the cube's middle over the fingers'
    dvec3 sum(0);
    const Body& body = stage.body(soft);
    for (const dvec3 x : body.surface_position) sum += x;
    return sum.y / double(body.surface_position.size()) - dynamic_cast<FixedBody&>(stage.body(left)).pose().position.y;
  }
  ToolStage stage;
  Entity soft, left, right;
};

TEST(SoftStep, AGripLiftsACubeInsideTheConeAndLosesItOutside) {
  for (const bool holds : {true, false}) {
    // Squeezed by F, the cube sticks while 2 mu F > m g; F is measured, and mu chosen on either side of that.
    GripOfBar probe(0.5);
    probe.stage.world.simulation.gravity = dvec3(0);
    probe.stage.prepare();
    probe.move({0.05, 0, 0}, {-0.05, 0, 0}, 0.08);
    probe.move({}, {}, 0.5);
    const double squeeze = probe.stage.contact_force(probe.soft, probe.left).x;
    const double needed = weight(probe.stage, probe.soft) / (2 * squeeze);
    ASSERT_GT(squeeze, 0.1);

    GripOfBar grip(needed * (holds ? 1.3 : 0.7));
    grip.stage.world.simulation.gravity = dvec3(0);
    grip.stage.prepare();
    grip.move({0.05, 0, 0}, {-0.05, 0, 0}, 0.08);
    grip.move({}, {}, 0.5);
    grip.stage.world.simulation.gravity = dvec3(0, -9.81, 0);
    grip.move({0, 0.02, 0}, {0, 0.02, 0}, 0.5);
    const double before = grip.height();
    grip.move({0, 0.02, 0}, {0, 0.02, 0}, 0.5);
    if (holds) {
      EXPECT_LT(std::abs(grip.height() - before), 2e-4);
      EXPECT_GT(grip.height(), -5e-3);
    } else {
      EXPECT_LT(grip.height() - before, -5e-3);
    }
  }
}

TEST(SoftStep, AHeldCubeNeverGainsEnergyOverTenThousandSteps) {
  GripOfBar grip(0.6, 5e-3);
  grip.stage.world.simulation.gravity = dvec3(0);
  grip.stage.prepare();
  grip.move({0.05, 0, 0}, {-0.05, 0, 0}, 0.08);
  grip.stage.world.simulation.gravity = dvec3(0, -9.81, 0);
  grip.move({}, {}, 0.1);
  // The fingers are at rest: only the weight does work on the cube.
  const double m = weight(grip.stage, grip.soft) / 9.81;
  const auto energy = [&] {
    double potential = 0.0;
    const Tissue& tissue = grip.stage.tissue(grip.soft).tissue();
    for (std::size_t n = 0; n < tissue.mass().size(); ++n)
      potential += tissue.mass()[n] * 9.81 * tissue.position()[n].y;
    return potential + grip.stage.kinetic_energy() + grip.stage.elastic_energy();
  };
  const double scale = grip.stage.elastic_energy() + m * 9.81 * kEdge;
  double least = energy(), gained = 0.0;
  for (int i = 0; i < 10000; ++i) {
    grip.stage.step();
    const double now = energy();
    gained = std::max(gained, now - least);
    least = std::min(least, now);
  }
  EXPECT_LT(gained, 1e-4 * scale);
  EXPECT_LT(grip.stage.kinetic_energy(), 1e-8 * scale);
}

TEST(SoftStep, TheSameInputGivesTheSameBits) {
  std::uint64_t hash[2];
  for (std::uint64_t& h : hash) {
    ToolStage stage(kSoftStepLength);
    Handle6 handle;
    TetMesh finger = tets::box(2, 4, 2, dvec3(-0.01, 0, -0.01), dvec3(0.01, 0.04, 0.01));
    tets::hold(
        finger, [](dvec3) { return false; }, [](dvec3 x) { return x.y > 0.03; });
    const Entity tool = stage.add_soft(finger, rubber(), {dvec3(0, 0.045, 0)}, &handle);
    stage.add_soft(cube(2), rubber(), {dvec3(0.005, 0.5 * kEdge + 1e-3, 0)});
    stage.add_rigid(ground_box(), ground(), {});
    stage.prepare();
    stage.lead(tool, dvec3(0, 0.035, 0), 0.2);
    stage.lead(tool, dvec3(0.01, 0.035, 0), 0.2);
    h = stage.hash();
  }
  EXPECT_EQ(hash[0], hash[1]);
}

TEST(SoftStep, AMotionThatIsNoNumberIsStoppedAndSaid) {
  ToolStage stage(kSoftStepLength);
  const Entity rigid = stage.add_rigid(scenes::box(dvec3(0.02)), {}, {dvec3(0, 0.2, 0)});
  const Entity soft = stage.add_soft(cube(1), rubber(), {dvec3(0.1, 0.2, 0)});
  stage.prepare();
  stage.step();
  dynamic_cast<RigidState&>(stage.body(rigid)).set_velocity(dvec3(std::nan(""), 0, 0), dvec3(0));
  const double before = stage.body(soft).surface_position[0].y;
  for (int i = 0; i < 10; ++i) stage.step();
  EXPECT_TRUE(stage.soft().dropped & kDroppedMotion);
  EXPECT_FALSE(explain_dropped(stage.soft().dropped).empty());
  for (const dvec3 x : stage.body(rigid).surface_position) EXPECT_TRUE(std::isfinite(dot(x, x)));
  EXPECT_LT(stage.body(soft).surface_position[0].y, before);  // the others fall on
}

TEST(SoftStep, ABodyThatCannotBeSolvedStandsStillAndSaysSo) {
  ToolStage stage(kSoftStepLength);
  const Entity soft = stage.add_soft(cube(2), rubber(), {dvec3(0, 0.2, 0)});
  stage.prepare();
  const_cast<Tissue&>(stage.tissue(soft).tissue()).position()[0] = dvec3(std::nan(""), 0, 0);
  stage.step();
  EXPECT_NE(stage.soft().dropped & (kDroppedFactor | kDroppedMotion), 0u);
}

TEST(PublishSoft, ASnapshotShowsWhatMovesAndWhatPushes) {
  ToolStage stage(kSoftStepLength);
  const Entity soft = stage.add_soft(cube(2), rubber(), {dvec3(0, 0.5 * kEdge, 0)});
  const Entity rigid = stage.add_rigid(scenes::box(dvec3(0.02)), {}, {dvec3(0.1, 0.01, 0)});
  stage.add_rigid(ground_box(), ground(), {});
  stage.prepare();
  for (int i = 0; i < 60; ++i) stage.step();
  ASSERT_TRUE(stage.world.soft_snapshots->acquire());
  const SoftSnapshot& shown = stage.world.soft_snapshots->read();
  EXPECT_EQ(shown.step, 60u);
  ASSERT_EQ(shown.objects.size(), 2u);  // the ground does not move
  EXPECT_EQ(shown.objects[0].object, soft);
  EXPECT_EQ(shown.objects[0].position.size(), stage.body(soft).surface_position.size());
  EXPECT_EQ(shown.objects[1].object, rigid);
  double pushed = 0.0;
  for (const ContactMark& contact : shown.contacts) pushed += double(std::abs(contact.force.y));
  const double whole = weight(stage, soft) + 1000 * 8e-6 * 9.81;
  EXPECT_NEAR(pushed, whole, 0.02 * whole);
}

}  // namespace
}  // namespace pliant
