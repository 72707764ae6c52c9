// Keys of PLIANT_deformable that an animation varies (KHR_animation_pointer): read, refused, spawned, saved.
#include "components/varying.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "content/gltf/write/gltf_save.h"
#include "content/level_file.h"
#include "tests/content/document_compare.h"
#include "tests/content/gltf_builder.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kStiffness = "/nodes/0/extensions/PLIANT_deformable/stiffness";

void add_channel(Gltf& gltf, const std::string& pointer, const std::vector<float>& values,
                 const char* interpolation = "LINEAR") {
  const std::size_t times = gltf.accessor(std::vector<float>{0, 0.5f, 2}, "SCALAR", kFloat, true),
                    output = gltf.accessor(values, "SCALAR", kFloat);
  if (!gltf.json.contains("animations"))
    gltf.json["animations"] =
        Json::array({{{"name", "hour"}, {"samplers", Json::array()}, {"channels", Json::array()}}});
  Json& animation = gltf.json["animations"][0];
  animation["samplers"].push_back({{"input", times}, {"output", output}, {"interpolation", interpolation}});
  animation["channels"].push_back(
      {{"sampler", animation["samplers"].size() - 1},
       {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
}

Gltf touchable() {
  Gltf gltf;
  gltf.primitive({{"POSITION", gltf.positions(kSquare)}});
  gltf.json["nodes"][0]["extensions"]["PLIANT_deformable"] = Json::object();
  gltf.json["extensionsUsed"] = {"PLIANT_deformable", "KHR_animation_pointer"};
  return gltf;
}

Level loaded(const Gltf& gltf) {
  Result<Level> level = gltf.load();
  EXPECT_TRUE(level.ok()) << (level ? "" : level.error().message());
  return level ? *level : Level{};
}

// The notes that have these words.
std::vector<std::string> with_words(const std::vector<std::string>& notes, const char* words) {
  std::vector<std::string> out;
  for (const std::string& note : notes)
    if (note.find(words) != std::string::npos) out.push_back(note);
  return out;
}

std::string refusal_of(const Level& level) {
  const Result<World> world = spawn(level);
  return world ? "" : world.error().message();
}

TEST(VaryingKeys, EveryInterpolationIsReadAndTheSurfaceBeginsWithTheFirstValue) {
  Gltf gltf = touchable();
  add_channel(gltf, kStiffness, {100, 300, 900});
  add_channel(gltf, "/nodes/0/extensions/PLIANT_deformable/contact_damping", {1, 2, 3}, "STEP");
  add_channel(gltf, "/nodes/0/extensions/PLIANT_deformable/friction", {0, 0.1f, 0, 0, 0.3f, 0, 0, 0.2f, 0},
              "CUBICSPLINE");
  const Level level = loaded(gltf);
  ASSERT_EQ(level.animations.size(), 1u);
  ASSERT_EQ(level.animations[0].channels.size(), 3u);
  EXPECT_EQ(level.animations[0].channels[0].key, "stiffness");
  EXPECT_TRUE(with_words(level.notes, "animation").empty());
  Result<World> world = spawn(level);
  ASSERT_TRUE(world.ok()) << world.error().message();
  const Entity thing = find_by_name(*world, "thing");
  EXPECT_EQ(world->registry.get<Deformable>(thing).stiffness, 100.0);
  const Varying& varying = world->registry.get<Varying>(thing);
  DeformableParameters at;
  vary(varying, 1.25, at);
  EXPECT_DOUBLE_EQ(at.stiffness, 600.0);
  EXPECT_DOUBLE_EQ(at.contact_damping, 2.0);
  EXPECT_DOUBLE_EQ(at.friction_static, 0.5 * (double{0.3f} + double{0.2f})) << "a spline without slopes, in its middle";
  EXPECT_DOUBLE_EQ(at.friction_sliding, at.friction_static);
  vary(varying, 2.5, at);
  EXPECT_DOUBLE_EQ(at.stiffness, 300.0) << "it starts over";
}

TEST(VaryingKeys, TheRestOfAJointIsReadFromItsFile) {
  Gltf gltf = touchable();
  gltf.json["nodes"][0]["extensions"] = {{"PLIANT_joint", {{"kind", "hinge"}, {"a", "arm"}, {"stiffness", 2}}}};
  gltf.json["nodes"].push_back(
      {{"name", "arm"}, {"mesh", 0}, {"extensions", {{"PLIANT_rigid_body", {{"mass", 0.1}}}}}});
  gltf.json["extensionsUsed"].insert(gltf.json["extensionsUsed"].end(), {"PLIANT_joint", "PLIANT_rigid_body"});
  add_channel(gltf, "/nodes/0/extensions/PLIANT_joint/rest", {0, -1.5f, 1});
  const Level level = loaded(gltf);
  ASSERT_EQ(level.animations.size(), 1u);
  EXPECT_EQ(level.animations[0].channels[0].key, "rest");
  gltf.json["nodes"][0]["extensions"] = {{"PLIANT_deformable", Json::object()}};
  EXPECT_THAT(gltf.refusal(), HasSubstr("PLIANT_joint of node 0, which has none"));
}

TEST(VaryingKeys, WhatIsWrongIsOneSentence) {
  const auto refused = [](const std::string& pointer, const std::vector<float>& values, const char* how = "LINEAR") {
    Gltf gltf = touchable();
    add_channel(gltf, pointer, values, how);
    const std::string message = gltf.refusal();
    EXPECT_EQ(message.find('\n'), std::string::npos);
    return message;
  };
  EXPECT_THAT(refused(kStiffness, {100, -1, 100}), HasSubstr("varies `stiffness` to -1, and it must be in the range"));
  EXPECT_THAT(refused(kStiffness, {100, 100}), HasSubstr("another length"));
  EXPECT_THAT(refused(kStiffness, {100, 100, 100}, "CUBICSPLINE"), HasSubstr("another length"));
  EXPECT_THAT(refused("/nodes/7/extensions/PLIANT_deformable/stiffness", {1, 2, 3}), HasSubstr("node 7 of 1"));
  Gltf bare = touchable();
  add_channel(bare, kStiffness, {1, 2, 3});
  bare.json["nodes"][0].erase("extensions");
  EXPECT_THAT(bare.refusal(), HasSubstr("PLIANT_deformable of node 0, which has none"));
}

TEST(VaryingKeys, OtherPointersAreOneSentence) {
  Gltf gltf = touchable();
  add_channel(gltf, "/materials/0/alphaCutoff", {0, 1, 0});
  add_channel(gltf, "/nodes/0/extensions/PLIANT_deformable/reach", {1, 2, 1});
  const Level level = loaded(gltf);
  const std::vector<std::string> said = with_words(level.notes, "not played");
  ASSERT_EQ(said.size(), 1u);
  EXPECT_THAT(said[0], HasSubstr("/materials/0/alphaCutoff"));
  EXPECT_THAT(said[0], HasSubstr("1 more pointer"));
  EXPECT_THAT(said[0], HasSubstr("stiffness"));
}

TEST(VaryingKeys, WhatFollowsFromAnotherKeyOrIsPaintedIsRefused) {
  Gltf gltf = touchable();
  gltf.json["nodes"][0]["extensions"]["PLIANT_deformable"]["young"] = 5000;
  add_channel(gltf, kStiffness, {100, 300, 900});
  EXPECT_THAT(refusal_of(loaded(gltf)), HasSubstr("`young`, from which it follows"));

  Level painted = loaded([] {
    Gltf with = touchable();
    add_channel(with, kStiffness, {100, 300, 900});
    return with;
  }());
  painted.meshes[0].primitives[0].stiffness = {1, 1, 2, 2};
  EXPECT_EQ(refusal_of(painted), "") << "the linear law has no share in the surface's motion";
  painted.nodes[0].deformable->spring = SpringLaw::kCubic;
  EXPECT_THAT(refusal_of(painted), HasSubstr("painted"));
}

TEST(VaryingKeys, MotionSaysWhichAnimationAndHowFast) {
  Gltf gltf = touchable();
  gltf.json["extensionsUsed"].push_back("PLIANT_motion");
  gltf.json["nodes"][0]["extensions"]["PLIANT_motion"] = {{"animation", "hour"}, {"speed", 2}, {"repeat", false}};
  add_channel(gltf, kStiffness, {100, 300, 900});
  std::vector<std::string> notes;
  Result<World> world = spawn(loaded(gltf), &notes);
  ASSERT_TRUE(world.ok()) << world.error().message();
  EXPECT_TRUE(with_words(notes, "PLIANT_motion").empty());
  DeformableParameters at;
  const Varying& varying = world->registry.get<Varying>(find_by_name(*world, "thing"));
  vary(varying, 0.625, at);
  EXPECT_DOUBLE_EQ(at.stiffness, 600.0);
  vary(varying, 5.0, at);
  EXPECT_DOUBLE_EQ(at.stiffness, 900.0);
}

// Whether as the document's own, or built anew for another one.
TEST(VaryingKeys, SavingKeepsTracksAndDropsThoseOfASurfaceThatIsNoneAnyMore) {
  const fs::path folder = fs::temp_directory_path() / ("pliant-varying-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  Gltf gltf = touchable();
  add_channel(gltf, kStiffness, {100, 300, 900});
  add_channel(gltf, "/nodes/0/extensions/PLIANT_deformable/friction", {0.1f, 0.3f, 0.2f}, "STEP");
  const Level level = loaded(gltf);
  Level changed = level, anew = level;
  changed.animations[0].channels[0].track.values[1].x = 350.0;
  anew.source = nullptr;
  for (const Level& each : {level, changed, anew}) {
    ASSERT_TRUE(save_level(each, folder / "saved.gltf").ok());
    const Result<Level> again = load_level(folder / "saved.gltf");
    ASSERT_TRUE(again.ok()) << again.error().message();
    ASSERT_EQ(again->animations.size(), 1u);
    ASSERT_EQ(again->animations[0].channels.size(), 2u);
    for (std::size_t c = 0; c < 2; ++c) {
      const LevelChannel &a = each.animations[0].channels[c], &b = again->animations[0].channels[c];
      EXPECT_EQ(a.key, b.key);
      EXPECT_EQ(a.node, b.node);
      EXPECT_EQ(a.track.times, b.track.times);
      EXPECT_EQ(a.track.values, b.track.values);
      EXPECT_EQ(a.track.interpolation, b.track.interpolation);
    }
  }
  for (Level each : {level, changed, anew}) {
    each.nodes[0].deformable.reset();
    ASSERT_TRUE(save_level(each, folder / "saved.gltf").ok());
    const Result<Level> again = load_level(folder / "saved.gltf");
    ASSERT_TRUE(again.ok()) << again.error().message();
    EXPECT_TRUE(again->animations.empty());
  }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace pliant::test
