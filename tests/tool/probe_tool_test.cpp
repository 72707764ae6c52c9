// Probes among soft and rigid bodies. Oracles: the coupling's law against rigid objects, action and reaction, weights,
// the same bits if a body is out of reach.
#include "systems/soft/body/probe_tool.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

using scenes::ToolStage;

constexpr double kSoftStep = 1.0 / 60.0;  // [s]

Pose at(dvec3 x) {
  return {x, {1, 0, 0, 0}};
}

Entity add_fixed(ToolStage& stage, dvec3 size, dvec3 centre) {
  RigidBody body;
  body.fixed = true;
  return stage.add_rigid(scenes::box(size), body, at(centre));
}

// [N] Force of a coupling of `probe` at an extension [m].
double law(const ToolStage& stage, Entity probe, double stretch) {
  const Probe& p = stage.world.registry.get<Probe>(probe);
  const Handle6 handle = probe_handle(p, stage.world.registry.get<HapticDevice>(p.device));
  return handle.max_force * std::tanh(handle.translation[0] * stretch / handle.max_force);
}

Entity add_probe(ToolStage& stage, dvec3 position, double radius, double max_force = 10.0) {
  const Entity probe = stage.add_probe(position, radius);
  stage.device(probe).max_force = max_force;
  return probe;
}

TEST(ProbeTool, OnAFixedBodyItsCouplingIsFelt) {
  struct Shape {
    const char* name;
    double radius, length;
    std::vector<vec3> points;
    double reach;  // [m] from the probe's origin down to its lowest point
  };
  for (const Shape& shape :
       {Shape{"sphere", 5e-3, 0.0, {}, 5e-3}, Shape{"point", 0.0, 0.0, {}, 5e-4}, Shape{"capsule", 3e-3, 0.1, {}, 3e-3},
        Shape{"fork", 2e-3, 0.0, {vec3(-0.01f, -0.01f, 0), vec3(0.01f, -0.01f, 0)}, 0.012}}) {
    SCOPED_TRACE(shape.name);
    ToolStage stage(kSoftStep);
    add_fixed(stage, dvec3(0.2, 0.02, 0.2), dvec3(0, -0.01, 0));
    const Entity probe = add_probe(stage, {0.003, 0.03, 0.002}, shape.radius);
    stage.world.registry.get<Probe>(probe).length = shape.length;
    stage.world.registry.get<Probe>(probe).points = shape.points;
    stage.prepare();
    stage.lead(probe, dvec3(0.003, 0.03, 0.002), 0.1);
    EXPECT_EQ(stage.read(probe).force, dvec3(0)) << "in the air";
    stage.lead(probe, dvec3(0.003, shape.reach - 2e-3, 0.002), 0.3);
    stage.lead(probe, dvec3(0.003, shape.reach - 2e-3, 0.002), 0.5);
    const ProbeReading pressed = stage.read(probe);
    EXPECT_NEAR(pressed.force.y, law(stage, probe, 2e-3), 0.03 * law(stage, probe, 2e-3));
    EXPECT_TRUE(pressed.in_contact);
    EXPECT_GT(pressed.normal.y, 0.999);
    EXPECT_NEAR(pressed.depth, 2e-3, 1e-4);
    stage.lead(probe, dvec3(0.003, 0.03, 0.002), 0.3);
    stage.lead(probe, dvec3(0.003, 0.03, 0.002), 0.2);
    EXPECT_LT(length(stage.read(probe).force), 1e-3);
    EXPECT_FALSE(stage.read(probe).in_contact);
  }
}

// It feels nothing until it has left, and then as ever.
TEST(ProbeTool, AFirstPoseInsideARigidBodyIsNotFeltUntilItIsLeft) {
  for (const double radius : {5e-4, 0.004}) {              // the first: a point
    for (const double y : {-0.05, -0.004, 0.002, 0.05}) {  // deep, just below, half in, outside
      SCOPED_TRACE(y);
      const bool inside = y < radius;
      ToolStage stage(kSoftStep);
      add_fixed(stage, dvec3(0.2, 0.2, 0.2), dvec3(0, -0.1, 0));
      const Entity probe = add_probe(stage, {0.003, y, 0.002}, radius > 1e-3 ? radius : 0.0);
      stage.prepare();
      double most = 0.0;
      const auto feel = [&] { most = std::max(most, length(stage.read(probe).force)); };
      stage.lead(probe, dvec3(0.003, y, 0.002), 0.1, feel);
      const SoftTally& tally = stage.world.soft->tally;
      EXPECT_EQ(stage.body(probe).absent, inside);
      if (inside) EXPECT_NEAR(tally.began_inside, radius - y, 2e-4);
      if (inside) EXPECT_EQ(stage.world.soft->bodies[tally.inside_a]->entity, probe);
      stage.lead(probe, dvec3(0.003, 0.9 * y + 0.003, 0.002), 0.03);  // its start is a jerk of the hand
      stage.lead(probe, dvec3(0.003, 0.03, 0.002), 0.27, feel);
      EXPECT_LT(most, 0.02) << "[N] on its way out: what is left of that";
      stage.lead(probe, dvec3(0.003, radius - 2e-3, 0.002), 0.3);
      stage.lead(probe, dvec3(0.003, radius - 2e-3, 0.002), 0.2);
      EXPECT_GT(stage.read(probe).force.y, 0.5 * law(stage, probe, 2e-3)) << "from outside";
    }
  }
}

SoftBody tissue() {
  SoftBody body;
  body.young = 1e4;
  body.poisson = 0.4;
  body.rayleigh = {2.0, 0.01};
  return body;
}

TEST(ProbeTool, ASoftBodyGivesWayAndPushesBack) {
  ToolStage stage(kSoftStep);
  TetMesh organ = tets::box(8, 4, 8, dvec3(-0.04, -0.04, -0.04), dvec3(0.04, 0.0, 0.04));
  tets::hold(
      organ, [](dvec3 x) { return x.y < -0.0399; }, [](dvec3) { return false; });
  stage.world.simulation.gravity = dvec3(0);
  const Entity body = stage.add_soft(std::move(organ), tissue(), at(dvec3(0)));
  const Entity probe = add_probe(stage, {0, 0.02, 0}, 8e-3);
  stage.prepare();
  stage.lead(probe, dvec3(0, 0.02, 0), 0.1);
  double last = 0.0;
  for (const double depth : {2e-3, 4e-3, 6e-3}) {
    stage.lead(probe, dvec3(0, 8e-3 - depth, 0), 0.2);
    stage.lead(probe, dvec3(0, 8e-3 - depth, 0), 0.6);
    const double force = stage.read(probe).force.y;
    EXPECT_GT(force, 1.3 * last) << depth;
    EXPECT_LT(force, 0.5 * law(stage, probe, depth)) << "most of the way is the tissue's";
    EXPECT_NEAR(-stage.contact_force(body, probe).y, force, 0.02 * force) << "action and reaction";
    last = force;
  }
  EXPECT_GT(last, 0.1);
}

// A slab that is a yielding surface next to a rigid table.
TEST(ProbeTool, MeetsWhatItIsSetToMeet) {
  for (const ProbeMeets meets : {ProbeMeets::kAll, ProbeMeets::kSurfaces, ProbeMeets::kBodies}) {
    SCOPED_TRACE(static_cast<int>(meets));
    ToolStage stage(kSoftStep);
    Deformable surface;
    surface.reach = 0.02;
    stage.add(scenes::sheet(20, 0.1), surface, at({-0.1, 0, 0}));
    add_fixed(stage, dvec3(0.1, 0.02, 0.1), dvec3(0.1, -0.01, 0));
    const Entity probe = add_probe(stage, {-0.1, 0.02, 0}, 4e-3);
    stage.world.registry.get<Probe>(probe).meets = meets;
    stage.prepare();
    const auto press = [&](double x) {
      stage.lead(probe, dvec3(x, 0.02, 0), 0.3);
      stage.lead(probe, dvec3(x, 2e-3, 0), 0.2);
      stage.lead(probe, dvec3(x, 2e-3, 0), 0.4);
      const double force = stage.read(probe).force.y;
      stage.lead(probe, dvec3(x, 0.02, 0), 0.2);
      return force;
    };
    const double on_surface = press(-0.1), on_table = press(0.1);
    EXPECT_EQ(on_surface > 0.05, meets != ProbeMeets::kBodies) << on_surface;
    EXPECT_EQ(on_table > 0.05, meets != ProbeMeets::kSurfaces) << on_table;
  }
}

// The same bits on a yielding surface, whether or not there is a body elsewhere.
TEST(ProbeTool, ABodyOutOfReachChangesNothing) {
  const auto forces = [](bool with_body) {
    ToolStage stage(kSoftStep);
    Deformable surface;
    surface.reach = 0.02;
    stage.add(scenes::sheet(20, 0.1), surface);
    if (with_body) add_fixed(stage, dvec3(0.1, 0.02, 0.1), dvec3(0.5, -0.01, 0));
    const Entity probe = add_probe(stage, {0, 0.02, 0}, 4e-3);
    stage.prepare();
    std::vector<dvec3> out;
    const auto note = [&] { out.push_back(stage.read(probe).force); };
    stage.lead(probe, dvec3(0, 1e-3, 0), 0.2, note);
    stage.lead(probe, dvec3(0.01, 1e-3, 0), 0.2, note);
    return out;
  };
  EXPECT_EQ(forces(true), forces(false));
}

TEST(ProbeTool, TwoProbesLiftASoftCube) {
  ToolStage stage(kSoftStep);
  add_fixed(stage, dvec3(0.3, 0.02, 0.3), dvec3(0, -0.01, 0));
  SoftBody body = tissue();
  body.density = 500.0;
  body.friction_static = 0.8;
  body.friction_sliding = 0.7;
  const Entity cube = stage.add_soft(tets::box(4, 4, 4, dvec3(-0.015), dvec3(0.015)), body, at({0, 0.0151, 0}));
  const Entity left = add_probe(stage, {-0.04, 0.015, 0}, 6e-3), right = add_probe(stage, {0.04, 0.015, 0}, 6e-3);
  stage.prepare();
  const auto both = [&](double x, double y, double seconds) {
    const dvec3 l = stage.device(left).position, r = stage.device(right).position;
    const int ticks = static_cast<int>(std::lround(seconds / stage.dt()));
    for (int i = 1; i <= ticks; ++i) {
      const double s = double(i) / ticks;
      stage.device(left).position = l + s * (dvec3(-x, y, 0) - l);
      stage.device(right).position = r + s * (dvec3(x, y, 0) - r);
      stage.run(stage.dt());
    }
  };
  const auto lowest = [&] {
    double y = 1e9;
    for (const dvec3& x : stage.body(cube).surface_position) y = std::min(y, x.y);
    return y;
  };
  both(0.04, 0.015, 0.3);
  both(0.0175, 0.015, 0.4);  // 3.5 mm into either side, hand to hand
  both(0.0175, 0.055, 0.8);
  both(0.0175, 0.055, 1.5);
  EXPECT_GT(lowest(), 0.035) << "it hangs between the two";
  const double weight = 500.0 * std::pow(0.03, 3) * 9.81;
  EXPECT_NEAR(stage.read(left).force.y + stage.read(right).force.y, -weight, 0.03 * weight);
  EXPECT_NEAR(stage.read(left).force.x, -stage.read(right).force.x, 0.03 * stage.read(right).force.x);
  const double there = lowest();
  both(0.0175, 0.055, 1.0);
  EXPECT_NEAR(lowest(), there, 1e-4) << "and stays";
  both(0.03, 0.055, 0.2);
  both(0.03, 0.055, 0.8);
  EXPECT_LT(lowest(), 1e-3) << "let go, it falls";
}

}  // namespace
}  // namespace pliant
