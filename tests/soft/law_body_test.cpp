// Bodies with laws for large strain in the soft step: squashed by contact, at rest, thrown, and changed while they run.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/soft/body/tissue_material.h"
#include "tests/soft/box_pile.h"

namespace pliant {
namespace {

constexpr double kLawStep = 1.0 / 60.0;  // [s]
constexpr double kCube = 0.05;           // [m]

SoftBody law_rubber(TissueLaw law) {
  SoftBody body;
  body.law = law;
  body.young = 2e4, body.poisson = 0.4, body.stiffening = 0.5;
  body.rayleigh = {0.0, 0.02};
  body.friction_static = body.friction_sliding = 0.0;
  return body;
}

// A cube of tissue on a floor without friction.
struct LawCube {
  scenes::ToolStage stage{kLawStep};
  Entity floor, cube, plate;
  explicit LawCube(const SoftBody& body, dvec3 gravity = dvec3(0)) {
    RigidBody still = test::fixed();
    still.friction_static = still.friction_sliding = 0.0;
    floor = stage.add_rigid(scenes::box(dvec3(1.0, 0.1, 1.0), dvec3(0, -0.05, 0)), still, {});
    const TetMesh tets = tets::box(3, 3, 3, dvec3(-0.5 * kCube), dvec3(0.5 * kCube));
    cube = stage.add_soft(tets, body, Pose{dvec3(0, 0.5 * kCube, 0), dquat(1, 0, 0, 0)});
    plate = stage.add_rigid(scenes::box(dvec3(0.5, 0.1, 0.5), dvec3(0, kCube + 0.051, 0)), still, {});
    stage.world.simulation.gravity = gravity;
    stage.prepare();
  }
  void lower(double speed) { dynamic_cast<FixedBody&>(stage.body(plate)).set_velocity(dvec3(0, -speed, 0), dvec3(0)); }
  void step(int count) {
    for (int i = 0; i < count; ++i) stage.step();
  }
};

// [Pa] nominal stress of a bar squashed to s by the law, its sides free.
double free_squash(const SoftBody& body, double s) {
  const LawConstants m{body.young / (2 * (1 + body.poisson)),
                       body.young * body.poisson / ((1 + body.poisson) * (1 - 2 * body.poisson)), body.stiffening};
  const auto stress = [&](double along, double c1, double across2) {
    const Density psi = elastic_law(body.law)(m, s * s + 2 * across2, s * across2);
    return 2 * psi.I * along + psi.J * c1;
  };
  double low = 0.5, high = 3.0;  // across
  for (int i = 0; i < 100; ++i) {
    const double mid = 0.5 * (low + high);
    (stress(mid, s * mid, mid * mid) < 0 ? low : high) = mid;
  }
  return stress(s, low * low, low * low);
}

TEST(LawBody, ASquashToHalfItsHeightHasTheForceOfTheLaw) {
  for (const TissueLaw law : {TissueLaw::kNeoHookean, TissueLaw::kFung}) {
    const SoftBody body = law_rubber(law);
    LawCube it(body);
    it.lower(0.025);  // the plate begins 1 mm above the cube
    it.step(62);
    it.lower(0.0);
    it.step(120);
    double top = 0.0;
    for (const dvec3& x : it.stage.tissue(it.cube).surface_position) top = std::max(top, x.y);
    const double s = top / kCube, want = -free_squash(body, s) * kCube * kCube;
    EXPECT_NEAR(s, 0.5, 0.01);
    EXPECT_NEAR(it.stage.contact_force(it.floor, it.cube).y, -want, 0.01 * want) << static_cast<int>(law);
    EXPECT_NEAR(it.stage.contact_force(it.plate, it.cube).y, want, 0.01 * want) << static_cast<int>(law);
    it.lower(-1.0);
    it.step(300);
    for (std::size_t i = 0; i < it.stage.tissue(it.cube).tets().nodes.size(); ++i) {
      const auto& tissue = it.stage.tissue(it.cube);
      const dvec3 edge = tissue.tissue().position()[i] - tissue.tissue().position()[0];
      EXPECT_NEAR(length(edge), length(tissue.tets().nodes[i] - tissue.tets().nodes[0]), 1e-4);
    }
  }
}

TEST(LawBody, ACubeRestsWithItsWeight) {
  for (const TissueLaw law : {TissueLaw::kNeoHookean, TissueLaw::kFung}) {
    LawCube it(law_rubber(law), dvec3(0, -9.81, 0));
    it.step(240);
    double weight = 0.0;
    for (const double m : it.stage.tissue(it.cube).tissue().mass()) weight += 9.81 * m;
    EXPECT_NEAR(it.stage.contact_force(it.cube, it.floor).y, weight, 1e-3 * weight) << static_cast<int>(law);
  }
}

// What a step would gain is taken out of its motion, which is said.
TEST(LawBody, AnImpactGainsNoEnergy) {
  for (const TissueLaw law : {TissueLaw::kNeoHookean, TissueLaw::kFung})
    for (const double speed : {20.0, 60.0, 200.0}) {
      SoftBody body = law_rubber(law);
      body.rayleigh = {0.0, 0.0};
      body.velocity = dvec3(3, -speed, 0);
      LawCube it(body);
      const double begin = it.stage.kinetic_energy();
      for (int i = 0; i < 120; ++i) {
        it.step(1);
        ASSERT_LT(it.stage.kinetic_energy() + it.stage.elastic_energy(), 1.001 * begin)
            << static_cast<int>(law) << ' ' << speed << ' ' << i;
      }
      if (speed != 60.0) EXPECT_EQ((it.stage.world.soft->dropped & kDroppedGain) != 0, speed == 200.0);
    }
}

TEST(LawBody, ABodyBeginsWithItsVelocity) {
  const dvec3 velocity(0.5, 2, -0.3), gravity(0, -9.81, 0);
  scenes::ToolStage stage(kLawStep);
  stage.world.simulation.gravity = gravity;
  SoftBody soft = law_rubber(TissueLaw::kCorotational);
  soft.rayleigh = {0, 0};
  soft.velocity = velocity;
  RigidBody rigid;
  rigid.velocity = velocity;
  const TetMesh tets = tets::box(2, 2, 2, dvec3(-0.02), dvec3(0.02));
  const Entity a = stage.add_soft(tets, soft, Pose{dvec3(0), dquat(1, 0, 0, 0)});
  const Entity b = stage.add_rigid(scenes::box(dvec3(0.03)), rigid, Pose{dvec3(1, 0, 0), dquat(1, 0, 0, 0)});
  stage.prepare();
  const std::vector<dvec3> from_a = stage.body(a).surface_position, from_b = stage.body(b).surface_position;
  const int n = 12;
  for (int i = 0; i < n; ++i) stage.step();
  // Implicit Euler: v + n g T after n steps.
  const double T = kLawStep;
  const dvec3 way = velocity * (n * T) + gravity * (T * T * n * (n + 1) / 2);
  for (std::size_t i = 0; i < from_a.size(); ++i)
    EXPECT_LT(length(stage.body(a).surface_position[i] - from_a[i] - way), 1e-9);
  for (std::size_t i = 0; i < from_b.size(); ++i)
    EXPECT_LT(length(stage.body(b).surface_position[i] - from_b[i] - way), 1e-9);
}

TEST(LawBody, ALawSetWhileItRunsGivesTheForceOfThatLaw) {
  const SoftBody before = law_rubber(TissueLaw::kCorotational), after = law_rubber(TissueLaw::kNeoHookean);
  LawCube it(before);
  it.lower(0.025);
  it.step(62);
  it.lower(0.0);
  it.step(60);
  ASSERT_TRUE(it.stage.soft().parameter_edits.push({it.cube, SoftSetting{material_of(after), 0.0, 0.0}}));
  it.step(120);
  double top = 0.0;
  for (const dvec3& x : it.stage.tissue(it.cube).surface_position) top = std::max(top, x.y);
  const double want = -free_squash(after, top / kCube) * kCube * kCube;
  EXPECT_NEAR(it.stage.contact_force(it.plate, it.cube).y, want, 0.01 * want);
}

}  // namespace
}  // namespace pliant
