// Rigid bodies with prescribed motion beside bodies that contacts move.
#include <gtest/gtest.h>

#include "scenes/tool_stage.h"
#include "tests/soft/box_pile.h"

namespace pliant::test {
namespace {

constexpr double kBeltG = 9.81, kBeltMu = 0.5;  // [m/s2], [1]

// A plate that begins to move along +X with `a` [m/s2]; linear between keys at every step.
PrescribedMotion plate_motion(double a, double seconds) {
  PrescribedMotion motion;
  motion.repeats = false;
  for (double t = 0.0; t <= seconds + 1e-9; t += kPileStep) {
    motion.translation.times.push_back(t);
    motion.translation.values.emplace_back(0.5 * a * t * t, 0.0, 0.0, 0.0);
  }
  motion.translation.length = seconds;
  return motion;
}

struct Conveyor {
  scenes::ToolStage stage{kPileStep};
  Entity plate, load;
  Conveyor(double a, bool soft) {
    stage.world.simulation.gravity = dvec3(0, -kBeltG, 0);
    RigidBody under = fixed();
    under.friction_static = under.friction_sliding = kBeltMu;
    plate = stage.add_rigid(scenes::box(dvec3(0.6, 0.02, 0.2), dvec3(0, -0.01, 0)), under, Pose{});
    stage.carry(plate, plate_motion(a, 2.0));
    if (soft) {
      SoftBody gel = pile_rubber();
      gel.rayleigh[0] = 0.0;  // which would resist motion itself
      gel.friction_static = gel.friction_sliding = kBeltMu;
      load = stage.add_soft(tets::box(4, 2, 4, dvec3(-0.02, 0, -0.02), dvec3(0.02, 0.02, 0.02)), gel, Pose{});
    } else {
      RigidBody body;
      body.friction_static = body.friction_sliding = kBeltMu;
      load = stage.add_rigid(scenes::box(dvec3(0.04, 0.02, 0.04), dvec3(0, 0.01, 0)), body, Pose{});
    }
    stage.prepare();
  }
  double place(Entity entity) {
    double sum = 0.0;
    for (const dvec3& x : stage.body(entity).surface_position) sum += x.x;
    return sum / double(stage.body(entity).surface_position.size());
  }
};

TEST(KinematicBodies, CarryALoadByFrictionUpToItsLimit) {
  for (const bool soft : {false, true})
    for (const double share : {0.6, 0.9, 1.5}) {  // of mu g
      const double a = share * kBeltMu * kBeltG;
      Conveyor scene(a, soft);
      const double from = scene.place(scene.load);
      constexpr int kSteps = 30;
      for (int i = 0; i < kSteps; ++i) scene.stage.step();
      const double t = kSteps * kPileStep, plate = scene.place(scene.plate), load = scene.place(scene.load) - from;
      EXPECT_NEAR(plate, 0.5 * a * t * t, 1e-9);
      const double due = 0.5 * std::min(a, kBeltMu * kBeltG) * t * t;
      EXPECT_NEAR(load, due, soft ? 0.03 * due : 0.02 * due) << soft << ' ' << share;
    }
}

TEST(KinematicBodies, GiveTheirLoadTheEnergyThatItGets) {
  Conveyor scene(0.6 * kBeltMu * kBeltG, false);
  for (int i = 0; i < 30; ++i) scene.stage.step();
  const auto& load = dynamic_cast<RigidState&>(scene.stage.body(scene.load));
  EXPECT_NEAR(scene.stage.soft().tally.fed, load.kinetic_energy(), 0.04 * load.kinetic_energy());
}

// A tool at rest on a belt is dragged along by mu N, at 1 kHz, too.
TEST(KinematicBodies, UnderAToolAreFeltAsTheyMove) {
  scenes::ToolStage stage(kPileStep);
  stage.world.simulation.gravity = dvec3(0);
  RigidBody under = fixed(), body;
  under.friction_static = under.friction_sliding = body.friction_static = body.friction_sliding = kBeltMu;
  const Entity belt = stage.add_rigid(scenes::box(dvec3(2.0, 0.02, 0.2), dvec3(0, -0.01, 0)), under, Pose{});
  PrescribedMotion motion;
  motion.repeats = false;
  motion.translation.times = {0.0, 4.0};
  motion.translation.values = {{0, 0, 0, 0}, {0.4, 0, 0, 0}};
  motion.translation.length = 4.0;
  stage.carry(belt, motion);
  Handle6 handle;
  const Entity tool = stage.add_rigid(scenes::box(dvec3(0.04)), body, Pose{dvec3(0, 0.022, 0)}, &handle);
  stage.prepare();
  stage.lead(tool, dvec3(0, 0.017, 0), 0.5);
  dvec3 least(1e9), most(-1e9);
  stage.lead(tool, dvec3(0, 0.017, 0), 0.5, [&] {
    const dvec3 f = stage.device_of(tool).force_sent;
    least = glm::min(least, f), most = glm::max(most, f);
  });
  EXPECT_GT(least.y, 0.3);
  EXPECT_NEAR(least.x, kBeltMu * least.y, 0.06 * least.y);
  EXPECT_NEAR(most.x, kBeltMu * most.y, 0.06 * most.y);
}

}  // namespace
}  // namespace pliant::test
