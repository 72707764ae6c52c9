// The shipped levels `hand_crowd`, `hand_squeeze`, `hand_grip` and `forceps` do what they are there to show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "systems/soft/body/soft_body_state.h"
#include "tests/tool/tool_level_run.h"

namespace pliant {
namespace {

using test::ToolLevelRun;

// No body is stopped, nothing sinks in, and the safety layer changes no force.
void expect_clean(const ToolLevelRun& scene) {
  const SoftTally& tally = scene.world.soft->tally;
  EXPECT_EQ(tally.halted_for, 0.0);
  EXPECT_LT(tally.deepest, 1.2e-3);
  for (const auto& tool : scene.world.tools->tools) {
    EXPECT_EQ(tool->force_safety.tally.of(SafetyLimit::kWithheld).ticks, 0u);
    EXPECT_EQ(tool->torque_safety.tally.of(SafetyLimit::kWithheld).ticks, 0u);
  }
}

TEST(HandLevels, TheCrowdIsPushedAndRolledByAHandThatFeelsIt) {
#ifdef PLIANT_SANITIZED
  GTEST_SKIP() << "minutes under a sanitizer";
#endif
  ToolLevelRun scene("hand_crowd");
  std::map<std::string, dvec3> began;
  for (const char* name : {"ball", "cube", "ring", "die", "marble", "drum"}) began[name] = scene.middle(name);
  scene.run(7.1);
  for (const auto& [name, place] : began) EXPECT_GT(length(scene.middle(name) - place), 0.010) << name;
  for (const char* name : {"ball", "marble", "drum"}) {  // these have rolled: a point of the surface has gone round
    const Body& body = scene.body(name);
    const dvec3 now = body.surface_position.front() - scene.middle(name);
    const dvec3 first = dvec3(body.collision_mesh->position(0));
    EXPECT_LT(dot(normalize(now), normalize(first)), std::cos(glm::radians(25.0))) << name;
  }
  EXPECT_GT(scene.largest, 1.0) << "[N]";
  expect_clean(scene);
}

TEST(HandLevels, SqueezedFingersPressOnOneAnotherAndThisIsFelt) {
#ifdef PLIANT_SANITIZED
  GTEST_SKIP() << "minutes under a sanitizer";
#endif
  ToolLevelRun scene("hand_squeeze");
  double most = 0.0, felt = 0.0;
  scene.run(2.6, [&] {
    most = std::max(most, scene.pressed("hand", "hand"));
    felt = std::max(felt, std::min(scene.pressed("hand", "wall_left"), scene.pressed("hand", "wall_right")));
  });
  EXPECT_GT(most, 0.3) << "[N] self-contact";
  EXPECT_GT(felt, 1.0) << "[N] on both sides";
  EXPECT_GT(scene.largest, 1.0) << "[N] on the device";
  expect_clean(scene);
}

// [degree] by which rigid part `k` of the hand has turned against its palm.
double bent(const ToolLevelRun& scene, int k) {
  const Body& hand = scene.body("hand");
  const int palm = hand.as_tissue()->rigid_count() - 1;
  const dquat turned = glm::conjugate(hand.part_pose(palm, 0.0)->rotation) * hand.part_pose(k, 0.0)->rotation;
  return glm::degrees(2.0 * std::acos(std::min(1.0, std::abs(turned.w))));
}

TEST(HandLevels, AGripBendsFifteenBonesOntoABall) {
#ifdef PLIANT_SANITIZED
  GTEST_SKIP() << "minutes under a sanitizer";
#endif
  ToolLevelRun scene("hand_grip");
  scene.run(0.8);
  for (int digit = 0; digit < 5; ++digit) EXPECT_GT(bent(scene, 3 * digit + 2), digit == 0 ? 20.0 : 30.0) << digit;
  EXPECT_GT(scene.pressed("hand", "ball"), 0.5) << "[N]";
  EXPECT_GT(scene.largest, 0.1) << "[N] on the device";
  EXPECT_LT(scene.largest, 4.0) << "[N] on the device";
  EXPECT_EQ(scene.world.soft->tally.unconverged, 0u);
  for (std::size_t i = 0; i < scene.world.soft->joints.size(); ++i)
    EXPECT_LT(scene.world.soft->joints.report(i).apart, 1e-3) << "[m]";
  expect_clean(scene);
}

TEST(HandLevels, ForcepsLiftAVesselAndPeelItOffItsBed) {
  ToolLevelRun scene("forceps");
  const auto bonds = [&] {  // whole ones, from the jaws on
    std::string out;
    for (std::size_t i = 0; i < scene.world.soft->joints.size(); ++i)
      if (scene.world.soft->joints.name(i).starts_with("bond_"))
        out += scene.world.soft->joints.report(i).broke_at < 0.0 ? '=' : '-';
    return out;
  };
  const auto free_end = [&] {  // [m] highest point of the vessel
    double y = 0.0;
    for (const dvec3& x : scene.body("vessel").surface_position) y = std::max(y, x.y);
    return y;
  };
  scene.run(1.1);
  EXPECT_LT(scene.largest, 0.01) << "[N] in free air";
  scene.run(1.2);
  [[maybe_unused]] const double lay = free_end();
  EXPECT_EQ(bonds(), std::string(13, '=')) << "whole until it is taken";
  scene.run(3.3);
  EXPECT_EQ(bonds().substr(0, 5), "-----") << "peeled at the jaws";
  EXPECT_EQ(bonds().substr(9), "====") << "and not yet far from them";
#ifndef PLIANT_SANITIZED  // the rest takes as long again
  scene.run(5.6);
  EXPECT_GT(free_end() - lay, 0.040) << "[m] lifted";
  EXPECT_EQ(bonds(), std::string(13, '-'));
#endif
  EXPECT_GT(scene.largest, 0.25) << "[N] the strength of a bond";
  EXPECT_LT(scene.largest, 2.0);
  expect_clean(scene);
}

}  // namespace
}  // namespace pliant
