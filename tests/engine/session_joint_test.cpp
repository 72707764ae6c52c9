// Joints of a scene and of a file: they hold, and what is wrong with one is a sentence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "content/author/edit_nodes.h"
#include "content/keys/unused_keys.h"
#include "content/level_file.h"
#include "tests/engine/session_rig.h"

namespace pliant {
namespace {

using testing::HasSubstr;

// A bob that hangs from the world by its top.
Scene hung(JointParameters joint = {.kind = JointKind::kBall, .a = "bob"}) {
  Scene scene("hall");
  scene.add_rigid_body("bob", box(0.02f), {.density = 1000.0}, {.position = {0, -0.02, 0}});
  scene.add_joint("hook", joint);
  return scene;
}

std::string said(JointParameters joint) {
  const auto session = Session::open(hung(joint));
  return session ? "" : session.error().message();
}

TEST(SessionJoint, HoldsWhatWouldFall) {
  Session session = opened(hung());
  ASSERT_TRUE(session.step(1000));
  std::vector<vec3> now;
  ASSERT_TRUE(session.vertices("bob", now));
  float low = 0.0f, high = -1.0f;
  for (const vec3& x : now) low = std::min(low, x.y), high = std::max(high, x.y);
  EXPECT_NEAR(low, -0.04f, 1e-6f);
  EXPECT_NEAR(high, 0.0f, 1e-6f);
}

TEST(SessionJoint, AnAnimationMovesTheRestOfASlider) {
  Scene scene = hung({.kind = JointKind::kSlider, .a = "bob", .stiffness = 1e4, .damping = 10.0});
  Level& level = scene.level();
  LevelNode& node = level.nodes.back();
  ASSERT_TRUE(node.joint);
  node.motion.emplace().repeat = false;
  LevelChannel channel{static_cast<std::int32_t>(level.nodes.size() - 1), NodeProperty::kKey, {}, "rest"};
  channel.track.times = {0.0, 0.5}, channel.track.length = 0.5;
  channel.track.values = {{0.0, 0, 0, 0}, {0.05, 0, 0, 0}};
  level.animations.push_back({"lift", 0.5, {channel}, -1});
  Session session = opened(scene);
  ASSERT_TRUE(session.step(1000));
  std::vector<vec3> now;
  ASSERT_TRUE(session.vertices("bob", now));
  double mean = 0.0;
  for (const vec3& x : now) mean += double{x.y} / double(now.size());
  EXPECT_NEAR(mean, -0.02 + 0.05, 1e-4);  // less m g / K
}

// A load that hangs from a tool is heavier than it. Their exchange between touch tick and soft step conserves momentum.
TEST(SessionJoint, AToolFeelsTheWeightOfAHeavierLoadAtAnySoftStep) {
  for (const double step : {1.0 / 240, 1.0 / 1000}) {
    Scene scene("crane");
    scene.simulation().soft_step = step;
    scene.add_rigid_body("hook", box(0.01f), {.mass = 0.03});
    scene.add_rigid_body("load", box(0.01f), {.mass = 0.05}, {.position = {0, -0.1, 0}});
    ASSERT_TRUE(scene.add_handle("hook"));
    scene.add_joint("rope", {.kind = JointKind::kRope, .a = "load", .b = "hook", .end = dvec3(0, 0.1, 0)},
                    {.position = {0, -0.1, 0}});
    Session session = opened(scene);
    ASSERT_TRUE(session.move("hook", {0, 0, 0}));
    ASSERT_TRUE(session.step(1500));
    double mean = 0.0;
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(session.step());
      mean += session.reading("hook")->force.y / 200.0;
    }
    EXPECT_NEAR(mean, -0.05 * 9.81, 0.01 * 0.05 * 9.81) << "soft_step " << step;
  }
}

TEST(SessionJoint, WhatIsWrongIsOneSentence) {
  EXPECT_THAT(said({.kind = JointKind::kBall}), HasSubstr("holds no body"));
  EXPECT_THAT(said({.kind = JointKind::kBall, .a = "bobb"}), HasSubstr("did you mean bob"));
  EXPECT_THAT(said({.kind = JointKind::kBall, .a = "bob", .b = "bob"}), HasSubstr("the same body twice"));
  EXPECT_THAT(said({.kind = JointKind::kHinge, .a = "bob", .limits = {0.5, 0.1}}), HasSubstr("exchange them"));
  EXPECT_THAT(said({.kind = JointKind::kHinge, .a = "bob", .limits = {0.5, 1.0}}), HasSubstr("outside of its limits"));
  EXPECT_THAT(said({.kind = JointKind::kHinge, .a = "bob", .stiffness = -1.0}), HasSubstr("must be in the range"));
  EXPECT_THAT(said({.kind = JointKind::kRope, .a = "bob", .end = dvec3(0, 0.1, 0), .length = 0.09}),
              HasSubstr("shorter than the distance"));
  EXPECT_EQ(said({.kind = JointKind::kHinge, .a = "bob", .limits = {-0.5, 1.0}, .stiffness = 1.0}), "");
  EXPECT_THAT(said({.kind = JointKind::kHinge, .a = "bob", .stiffness = 1.0, .grip = "bobs"}),
              HasSubstr("no tool or probe"));
  EXPECT_THAT(said({.kind = JointKind::kHinge, .a = "bob", .grip = "bob"}), HasSubstr("without `stiffness`"));
}

TEST(SessionJoint, KeysThatAKindDoesNotReadAreNamed) {
  const Scene scene = hung({.kind = JointKind::kBall, .a = "bob", .limits = {-1.0, 1.0}, .length = 0.3});
  std::vector<std::string> keys;
  for (const UnusedKey& key : find_unused_keys(scene.level())) keys.push_back(key.pointer);
  EXPECT_THAT(keys, testing::UnorderedElementsAre("PLIANT_joint/limits", "PLIANT_joint/length"));
}

TEST(SessionJoint, FollowsNamesOfBodies) {
  Scene scene = hung();
  Level& level = scene.level();
  ASSERT_TRUE(rename_node(level, 0, "weight"));
  EXPECT_EQ(level.nodes[1].joint->a, "weight");
  remove_node(level, 0);
  EXPECT_FALSE(level.nodes[0].joint);
}

}  // namespace
}  // namespace pliant
