// Bodies pressed and dragged by the mouse. Oracles: a spring's law, action and reaction, the energy after release.
#include "systems/tool/pull.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/tet_shapes.h"
#include "scenes/tool_stage.h"
#include "systems/tool/tool_touch_state.h"

namespace pliant {
namespace {

using scenes::ToolStage;

Pose pulled_from(dvec3 x) {
  return {x, {1, 0, 0, 0}};
}

// A block of tissue about the origin, or a rigid box, and a probe that hovers above it.
struct PullScene {
  ToolStage stage{1.0 / 60.0};
  Entity body, probe;

  explicit PullScene(bool soft, bool pinned = false, double density = 1000.0) {
    stage.world.simulation.gravity = dvec3(0);
    if (soft) {
      TetMesh block = tets::box(4, 4, 4, dvec3(-0.03), dvec3(0.03));
      tets::hold(block, [&](dvec3 x) { return pinned && x.y < -0.0299; });
      SoftBody tissue;
      tissue.young = 1e4;
      tissue.density = density;
      body = stage.add_soft(std::move(block), tissue, pulled_from(dvec3(0)));
    } else {
      RigidBody box;
      box.density = density;
      body = stage.add_rigid(scenes::box(dvec3(0.06)), box, pulled_from(dvec3(0)));
    }
    probe = stage.add_probe({0, 0.05, 0}, 3e-3);
    stage.device(probe).max_force = 3.3;
    stage.prepare();
    hold().hovers = true;
    stage.lead(probe, {0, 0.05, 0}, 0.1);
  }
  ProbeHold& hold() { return stage.world.registry.get<Probe>(probe).hold; }
  void grab(dvec3 at) {
    hold() = {false, body, at, hold().number + 1};
    stage.lead(probe, at, 0.02);
  }
  void let_go() { hold() = {true, kNoEntity, {}, hold().number}; }
  dvec3 centre() {
    dvec3 sum(0);
    const std::vector<dvec3>& x = stage.body(body).surface_position;
    for (const dvec3 p : x) sum += p;
    return sum / static_cast<double>(x.size());
  }
};

TEST(Pull, AFreeBodyComesAlongSoftOrRigidHeavyOrLight) {
  for (const bool soft : {true, false})
    for (const double density : {10.0, 1000.0}) {
      SCOPED_TRACE(::testing::Message() << (soft ? "soft " : "rigid ") << density);
      PullScene scene(soft, false, density);
      scene.grab({0, 0.03, 0});
      double most = 0.0;
      scene.stage.lead(scene.probe, {0.05, 0.03, 0}, 0.5,
                       [&] { most = std::max(most, length(scene.stage.read(scene.probe).force)); });
      for (int i = 0; i < 10; ++i) scene.stage.lead(scene.probe, {0.05, 0.03, 0}, 0.4);
      EXPECT_GT(most, 1e-4);
      EXPECT_LE(most, 3.3 + 1e-9);
      // No farther from the mouse than the middle of its upper face is from its corners' sphere: it may have turned.
      EXPECT_LT(length(scene.centre() - dvec3(0.05, 0.03, 0)), 0.06) << "it hangs about the mouse";
      EXPECT_LT(length(scene.stage.read(scene.probe).force), 0.3) << "relaxed";
    }
}

TEST(Pull, APinnedBodyPullsBackWithWhatThePinsHold) {
  PullScene scene(true, true);
  scene.grab({0, 0.03, 0});
  scene.stage.lead(scene.probe, {0, 0.04, 0}, 0.5);
  scene.stage.lead(scene.probe, {0, 0.04, 0}, 1.5);
  const ProbeReading read = scene.stage.read(scene.probe);
  EXPECT_LT(read.force.y, -0.1) << "downwards, on the hand";
  EXPECT_TRUE(read.in_contact);
  const Vector& elastic = scene.stage.tissue(scene.body).tissue().elastic_force();
  const TetMesh& tets = scene.stage.tissue(scene.body).tets();
  double pins = 0.0;
  for (std::uint32_t i = tets.pinned_begin(); i < tets.node_count(); ++i) pins += elastic[3 * i + 1];
  EXPECT_NEAR(pins, -read.force.y, 0.05 * std::abs(read.force.y)) << "action and reaction";
}

TEST(Pull, LettingGoFeedsNoEnergy) {
  PullScene scene(true, true);
  scene.grab({0, 0.03, 0});
  scene.stage.lead(scene.probe, {0.03, 0.05, 0}, 0.4);
  scene.let_go();
  scene.stage.run(0.02);
  double before = scene.stage.kinetic_energy() + scene.stage.elastic_energy();
  EXPECT_GT(before, 1e-4);
  for (int i = 0; i < 60; ++i) {
    scene.stage.run(1.0 / 60.0);
    const double now = scene.stage.kinetic_energy() + scene.stage.elastic_energy();
    EXPECT_LE(now, before * (1.0 + 1e-6) + 1e-12) << i;
    before = now;
  }
  EXPECT_EQ(scene.stage.read(scene.probe).force, dvec3(0));
}

TEST(Pull, ABodyIsPressedByAProbeThatHovered) {
  for (const bool soft : {true, false}) {
    PullScene scene(soft, true);
    if (!soft) continue;
    scene.stage.lead(scene.probe, {0, 0.034, 0}, 0.1);
    scene.hold().hovers = false;
    scene.stage.lead(scene.probe, {0, 0.029, 0}, 0.3);
    scene.stage.lead(scene.probe, {0, 0.029, 0}, 0.5);
    EXPECT_GT(scene.stage.read(scene.probe).force.y, 0.02) << "pushed back";
  }
}

TEST(Pull, AHoveringProbeMeetsNothingOnItsWay) {
  PullScene scene(true);
  scene.stage.lead(scene.probe, {0, -0.05, 0}, 0.05);
  EXPECT_EQ(scene.stage.read(scene.probe).force, dvec3(0));
  EXPECT_LT(length(scene.centre()), 1e-6) << "through the body, which did not feel it";
}

}  // namespace
}  // namespace pliant
