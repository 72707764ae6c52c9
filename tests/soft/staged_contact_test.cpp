// Tissue with the second-order step in contact: no energy from contact or friction, no rebound by the scheme, rest, and
// the same bits for any number of threads. And quasi-static tissue.
#include <gtest/gtest.h>

#include <cmath>

#include "runtime/hash.h"
#include "runtime/parallel.h"
#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/prepare_world.h"
#include "systems/soft/body/equilibrium.h"
#include "tests/soft/box_pile.h"

namespace pliant {
namespace {

constexpr double kStagedStep = 1.0 / 60.0;  // [s]

SoftBody staged_rubber(TissueLaw law = TissueLaw::kCorotational) {
  SoftBody body;
  body.law = law;
  body.young = 2e4, body.poisson = 0.4;
  body.integrator = StepMethod::kSecondOrder;
  return body;
}

// A cube of 5 cm over a floor, turned so that it strikes with an edge.
struct StagedCube {
  scenes::ToolStage stage;
  Entity floor, cube;
  StagedCube(const SoftBody& body, double step, double turned = 0.0, dvec3 gravity = dvec3(0)) : stage(step) {
    floor = stage.add_rigid(scenes::box(dvec3(1.0, 0.1, 1.0), dvec3(0, -0.05, 0)), test::fixed(), {});
    const dquat q = glm::angleAxis(turned, normalize(dvec3(1, 0, 0.7)));
    cube = stage.add_soft(tets::box(3, 3, 3, dvec3(-0.025), dvec3(0.025)), body,
                          Pose{dvec3(0, turned == 0.0 ? 0.025 : 0.045, 0), q});
    stage.world.simulation.gravity = gravity;
    stage.prepare();
  }
  double energy() { return stage.kinetic_energy() + stage.elastic_energy(); }
};

// 1 % is what a body may take back of what it lost before (TwoStages).
TEST(StagedContact, AnImpactMakesNoEnergy) {
  for (const TissueLaw law : {TissueLaw::kCorotational, TissueLaw::kNeoHookean})
    for (const double speed : {0.2, 2.0, 20.0})
      for (const double turned : {0.0, 0.5})
        for (const double step : {1.0 / 30, 1.0 / 60}) {
          SoftBody body = staged_rubber(law);
          body.velocity = dvec3(0.3, -1, 0.1) * speed;
          StagedCube it(body, step, turned);
          const double begin = it.energy();
          double most = 0.0;
          for (int i = 0; i < 60; ++i) {
            it.stage.step();
            most = std::max(most, it.energy());
          }
          EXPECT_LT(most, 1.011 * begin) << static_cast<int>(law) << ' ' << speed << ' ' << turned << ' ' << step;
        }
}

// Bodies that step otherwise take part: a rigid box thrown at a pinned block and at a free one.
TEST(StagedContact, ARigidBoxThrownAtItMakesNoEnergy) {
  for (const bool pinned : {true, false})
    for (const double speed : {0.3, 1.0, 4.0})
      for (const double step : {1.0 / 30, 1.0 / 60, 1.0 / 500}) {
        scenes::ToolStage stage(step);
        stage.world.simulation.gravity = dvec3(0);
        TetMesh tets = tets::box(4, 2, 4, dvec3(-0.05, 0, -0.05), dvec3(0.05, 0.04, 0.05));
        if (pinned) tets::hold(tets, [](dvec3 x) { return x.y < 1e-9; });
        stage.add_soft(tets, staged_rubber(), {});
        RigidBody rigid;
        rigid.density = 500.0;
        rigid.velocity = dvec3(0.5, -1, 0.2) * speed;
        const Entity box = stage.add_rigid(scenes::box(dvec3(0.03)), rigid,
                                           Pose{dvec3(-0.01, 0.062, 0.003), glm::angleAxis(0.4, dvec3(0.6, 0, 0.8))});
        stage.prepare();
        const auto energy = [&] {
          return stage.kinetic_energy() + stage.elastic_energy() +
                 dynamic_cast<RigidState&>(stage.body(box)).kinetic_energy();
        };
        stage.step();
        const double begin = energy();
        double most = 0.0;
        for (int i = 0; i < 150; ++i) stage.step(), most = std::max(most, energy());
        EXPECT_LT(most, 1.011 * begin) << pinned << ' ' << speed << ' ' << step;
      }
}

// A cube so stiff that it is rigid in a step stops on the floor: the contact's rows do not rebound.
TEST(StagedContact, AStiffBodyThatLandsDoesNotRebound) {
  SoftBody body = staged_rubber();
  body.young = 1e9;
  body.velocity = dvec3(0, -1, 0);
  StagedCube it(body, kStagedStep);
  it.stage.step();
  const Tissue& tissue = it.stage.tissue(it.cube).tissue();
  for (const dvec3 v : tissue.velocity()) EXPECT_LT(std::abs(v.y), 0.02);
}

TEST(StagedContact, ABlockRestsOnTheFloorWithItsWeight) {
  const dvec3 gravity(0, -9.81, 0);
  SoftBody body = staged_rubber();
  body.rayleigh = {0.0, 0.02};
  StagedCube it(body, kStagedStep, 0.0, gravity);
  for (int i = 0; i < 120; ++i) it.stage.step();
  const double weight = body.density * std::pow(0.05, 3) * 9.81;
  for (int i = 0; i < 60; ++i) {
    it.stage.step();
    EXPECT_NEAR(it.stage.contact_force(it.cube, it.floor).y, weight, 1e-3 * weight);
    for (const dvec3 v : it.stage.tissue(it.cube).tissue().velocity()) EXPECT_LT(length(v), 1e-4);
  }
}

// On an incline it slides beyond the friction angle, as far as the closed form has it, and stays below it.
TEST(StagedContact, OnAnInclineItSlipsBeyondTheFrictionAngle) {
  for (const double mu : {0.2, 0.6}) {
    constexpr double kTan = 0.4;
    const double angle = std::atan(kTan), seconds = 0.5;
    SoftBody body = staged_rubber();
    body.young = 2e5;
    body.rayleigh = {0.0, 0.005};
    body.friction_static = body.friction_sliding = mu;
    scenes::ToolStage stage(1.0 / 240);
    RigidBody floor = test::fixed();
    floor.friction_static = floor.friction_sliding = mu;
    stage.add_rigid(scenes::box(dvec3(4.0, 0.1, 1.0), dvec3(0, -0.05, 0)), floor, {});
    const Entity cube = stage.add_soft(tets::box(3, 3, 3, dvec3(-0.025), dvec3(0.025)), body,
                                       Pose{dvec3(0, 0.025, 0), dquat(1, 0, 0, 0)});
    stage.world.simulation.gravity = 9.81 * dvec3(std::sin(angle), -std::cos(angle), 0);
    stage.prepare();
    for (int i = 0; i < 120; ++i) stage.step();
    dvec3 mean(0);
    const Tissue& tissue = stage.tissue(cube).tissue();
    for (const dvec3 x : tissue.position()) mean += x / static_cast<double>(tissue.mass().size());
    const double way = mu > kTan ? 0.0 : 0.5 * 9.81 * (std::sin(angle) - mu * std::cos(angle)) * seconds * seconds;
    EXPECT_NEAR(mean.x, way, 0.03 * way + 2e-3) << mu;
  }
}

TEST(StagedContact, TheBitsAreTheSameForAnyNumberOfThreads) {
  const unsigned before = thread_count();
  std::vector<std::uint64_t> hashes;
  for (const unsigned threads : {1u, 2u, 4u}) {
    set_thread_count(threads);
    SoftBody body = staged_rubber(TissueLaw::kNeoHookean);
    body.velocity = dvec3(0.3, -1, 0.1);
    StagedCube it(body, kStagedStep, 0.5, dvec3(0, -9.81, 0));
    for (int i = 0; i < 60; ++i) it.stage.step();
    Hash hash;
    for (const dvec3 x : it.stage.tissue(it.cube).tissue().position()) hash.add(x.x), hash.add(x.y), hash.add(x.z);
    hashes.push_back(hash.value());
  }
  set_thread_count(before);
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

TEST(QuasiStatic, ASaggingBarIsInEquilibriumAfterAFewSteps) {
  for (const TissueLaw law : {TissueLaw::kCorotational, TissueLaw::kNeoHookean}) {
    TetMesh tets = tets::box(6, 2, 2, dvec3(0, -0.01, -0.01), dvec3(0.12, 0.01, 0.01));
    tets::hold(tets, [](dvec3 x) { return x.x < 1e-9; });
    SoftBody body = staged_rubber(law);
    body.young = 2e5;
    const Equilibrium rest = find_equilibrium(tets, body, dvec3(0, -9.81, 0));
    ASSERT_TRUE(rest.converged);
    body.integrator = StepMethod::kQuasiStatic;
    scenes::ToolStage stage(kStagedStep);
    const Entity bar = stage.add_soft(tets, body, {});
    stage.prepare();
    const auto off = [&] {
      double most = 0.0;
      for (std::size_t i = 0; i < rest.nodes.size(); ++i)
        most = std::max(most, length(stage.tissue(bar).tissue().position()[i] - rest.nodes[i]));
      return most / rest.most;
    };
    const int steps = law == TissueLaw::kCorotational ? 3 : 8;
    for (int i = 0; i < steps; ++i) stage.step();
    EXPECT_LT(off(), 1e-4) << static_cast<int>(law);
  }
}

// The force is that of the depth, however fast the plate came there.
TEST(QuasiStatic, APressedBlockGivesTheForceOfItsDepthWithoutInertia) {
  std::vector<double> force;
  for (const double speed : {0.01, 0.12}) {  // [m/s]
    SoftBody body = staged_rubber();
    body.integrator = StepMethod::kQuasiStatic;
    TetMesh tets = tets::box(3, 3, 3, dvec3(-0.025), dvec3(0.025));
    tets::hold(tets, [](dvec3 x) { return x.y < -0.0249; });
    scenes::ToolStage stage(kStagedStep);
    stage.world.simulation.gravity = dvec3(0);
    const Entity cube = stage.add_soft(tets, body, {});
    RigidBody still = test::fixed();
    const Entity plate = stage.add_rigid(scenes::box(dvec3(0.2, 0.02, 0.2), dvec3(0, 0.035, 0)), still, {});
    stage.prepare();
    dynamic_cast<FixedBody&>(stage.body(plate)).set_velocity(dvec3(0, -speed, 0), dvec3(0));
    const int steps = static_cast<int>(std::lround(0.002 / (speed * kStagedStep)));
    for (int i = 0; i < steps; ++i) stage.step();
    force.push_back(stage.contact_force(plate, cube).y);
  }
  EXPECT_GT(force[0], 0.1);
  EXPECT_NEAR(force[1], force[0], 0.02 * force[0]);
}

TEST(QuasiStatic, ABodyThatNothingHoldsIsRefused) {
  scenes::ToolStage stage(kStagedStep);
  SoftBody body = staged_rubber();
  body.integrator = StepMethod::kQuasiStatic;
  stage.add_soft(tets::box(1, 1, 1, dvec3(-0.02), dvec3(0.02)), body, {});
  const Status status = prepare_world(stage.world);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().what.find("nothing holds it"), std::string::npos);
}

TEST(StagedContact, AToolsTissueIsRefused) {
  scenes::ToolStage stage(kStagedStep);
  TetMesh tets = tets::box(2, 1, 1, dvec3(-0.02), dvec3(0.02));
  tets::hold(
      tets, [](dvec3) { return false; }, [](dvec3 x) { return x.x < -0.019; });
  const Handle6 handle;
  stage.add_soft(tets, staged_rubber(), {}, &handle);
  const Status status = prepare_world(stage.world);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().what.find("integrator"), std::string::npos);
}

}  // namespace
}  // namespace pliant
