// Relaxing, contracting and filled bodies in the soft step.
#include <gtest/gtest.h>

#include <cmath>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/soft/body/equilibrium.h"
#include "tests/soft/box_pile.h"

namespace pliant {
namespace {

constexpr double kSoftCube = 0.05, kFrame = 1.0 / 60.0;  // [m], [s]

SoftBody relaxing_rubber(TissueLaw law) {
  SoftBody body;
  body.law = law;
  body.young = 2e4, body.poisson = 0.4, body.density = 10.0;
  body.prony = {.count = 2, .arms = {Prony::Arm{0.3, 0.2}, Prony::Arm{0.2, 1.5}}};
  body.friction_static = body.friction_sliding = 0.0;
  return body;
}

// A plate presses a cube in one step's time, and stays.
TEST(RelaxingBody, AHeldSquashRelaxesByTheSeries) {
  for (const TissueLaw law : {TissueLaw::kCorotational, TissueLaw::kNeoHookean}) {
    const SoftBody body = relaxing_rubber(law);
    scenes::ToolStage stage(kFrame);
    stage.world.simulation.gravity = dvec3(0);
    RigidBody still = test::fixed();
    still.friction_static = still.friction_sliding = 0.0;
    const Entity floor = stage.add_rigid(scenes::box(dvec3(1.0, 0.1, 1.0), dvec3(0, -0.05, 0)), still, {});
    const TetMesh tets = tets::box(3, 3, 3, dvec3(-0.5 * kSoftCube), dvec3(0.5 * kSoftCube));
    const Entity cube = stage.add_soft(tets, body, Pose{dvec3(0, 0.5 * kSoftCube, 0), dquat(1, 0, 0, 0)});
    const Entity plate = stage.add_rigid(scenes::box(dvec3(0.5, 0.1, 0.5), dvec3(0, kSoftCube + 0.05, 0)), still, {});
    stage.prepare();
    auto& moving = dynamic_cast<FixedBody&>(stage.body(plate));
    const int press = 12;
    moving.set_velocity(dvec3(0, -0.1 * kSoftCube / (press * kFrame), 0), dvec3(0));
    for (int i = 0; i < press; ++i) stage.step();
    moving.set_velocity(dvec3(0), dvec3(0));
    stage.step();
    // Of a ramp from 0 to T0, in units of the stress at once, at a time t after its beginning.
    const double T0 = press * kFrame;
    const auto ramp = [&](double t) {
      double g = body.prony.remains();
      for (std::size_t i = 0; i < body.prony.count; ++i) {
        const auto [share, time] = body.prony.arms[i];
        g += share * time / T0 * std::expm1(T0 / time) * std::exp(-t / time);
      }
      return g;
    };
    const double first = stage.contact_force(floor, cube).y, begin = T0 + kFrame;
    ASSERT_LT(first, -1.0);
    for (int i = 1; i <= 120; ++i) {
      stage.step();
      EXPECT_NEAR(stage.contact_force(floor, cube).y / first, ramp(begin + i * kFrame) / ramp(begin), 0.01)
          << static_cast<int>(law) << ' ' << i;
    }
  }
}

TEST(RelaxingBody, RestsUnderGravityAsTheRelaxedTissue) {
  SoftBody body = relaxing_rubber(TissueLaw::kCorotational);
  body.density = 1000.0;
  TetMesh mesh = tets::box(2, 2, 2, dvec3(0), dvec3(kSoftCube));
  tets::hold(mesh, [](dvec3 p) { return p.y > kSoftCube - 1e-9; });
  const double sag = find_equilibrium(mesh, body, dvec3(0, -9.81, 0)).most;
  body.young *= body.prony.remains(), body.prony = {};
  EXPECT_NEAR(sag, find_equilibrium(mesh, body, dvec3(0, -9.81, 0)).most, 1e-6 * sag);
}

}  // namespace
}  // namespace pliant
