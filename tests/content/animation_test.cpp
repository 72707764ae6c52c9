// glTF animations and motion scripts: read, rejected, spawned, saved.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "content/gltf/write/gltf_save.h"
#include "content/level_file.h"
#include "tests/content/document_compare.h"
#include "tests/content/gltf_builder.h"
#include "tests/content/mesh_shapes.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const std::vector<float> kTimes = {0, 1, 2};
const std::vector<float> kTurn = {0, 0, 0, 1, 0, 0.70710678f, 0, 0.70710678f, 0, 1, 0, 0};  // 0, 90, 180 deg about y

// A square that an animation rotates and translates: channel 0 rotates, channel 1 translates.
Gltf turning() {
  Gltf gltf;
  gltf.primitive({{"POSITION", gltf.positions(kSquare)}});
  const std::size_t input = gltf.accessor(kTimes, "SCALAR", kFloat, true), turn = gltf.accessor(kTurn, "VEC4", kFloat);
  const std::size_t shift = gltf.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3", kFloat);
  gltf.json["animations"] = Json::array(
      {{{"name", "turn"},
        {"samplers", Json::array({{{"input", input}, {"output", turn}},
                                  {{"input", input}, {"output", shift}, {"interpolation", "STEP"}}})},
        {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}},
                                  {{"sampler", 1}, {"target", {{"node", 0}, {"path", "translation"}}}}})}}});
  return gltf;
}
Json& animation(Gltf& gltf) {
  return gltf.json["animations"][0];
}

Level loaded(const Gltf& gltf) {
  Result<Level> level = gltf.load();
  EXPECT_TRUE(level.ok()) << (level ? "" : level.error().message());
  return level ? *level : Level{};
}
World spawned(const Level& level, std::vector<std::string>* notes = nullptr) {
  Result<World> world = spawn(level, notes);
  EXPECT_TRUE(world.ok()) << (world ? "" : world.error().message());
  return world ? std::move(*world) : World{};
}
std::string spawn_refusal(const Level& level) {
  const Result<World> world = spawn(level);
  return world ? "" : world.error().message();
}
const PrescribedMotion& motion_of(const World& world, const char* name) {
  return world.motions[world.registry.get<Kinematic>(find_by_name(world, name)).motion];
}

TEST(Animation, ChannelsBecomeTracksThatLastAsLongAsTheirAnimation) {
  const Level level = loaded(turning());
  ASSERT_EQ(level.animations.size(), 1u);
  EXPECT_EQ(level.animations[0].name, "turn");
  EXPECT_EQ(level.animations[0].length, 2.0);
  ASSERT_EQ(level.animations[0].channels.size(), 2u);
  const LevelChannel &turn = level.animations[0].channels[0], &shift = level.animations[0].channels[1];
  EXPECT_EQ(turn.property, NodeProperty::kRotation);
  EXPECT_EQ(turn.track.times, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(shift.track.interpolation, Interpolation::kStep);
  EXPECT_EQ(shift.track.values[1], glm::dvec4(1, 0, 0, 0));
}

TEST(Animation, CarriesTheNodeInTheWorldFromWhereItBegins) {
  Level level = loaded(turning());
  level.nodes[0].local.translation = {9, 9, 9};  // overridden by the motion
  level.animations[0].channels[1].track.values[0] = {0.5, 0, 0, 0};
  make_touchable(level);
  const World world = spawned(level);
  const Entity thing = find_by_name(world, "thing");
  EXPECT_EQ(world.registry.get<Pose>(thing).position, dvec3(0.5, 0, 0));
  const LocalFrame frame = sample_motion(motion_of(world, "thing"), world.registry.get<LocalTransform>(thing), 0.5);
  EXPECT_NEAR(std::abs(glm::dot(frame.rotation, glm::angleAxis(0.25 * 3.14159265358979, dvec3(0, 1, 0)))), 1.0, 1e-7);
}

TEST(Animation, BadOnesAreRefusedWithASentence) {
  const auto refused = [](const auto& spoil, const char* part) {
    Gltf gltf = turning();
    spoil(gltf);
    EXPECT_THAT(gltf.refusal(), HasSubstr(part));
  };
  refused([](Gltf& g) { animation(g)["samplers"][0]["output"] = 77; }, "/animations/0/samplers/0/output");
  refused([](Gltf& g) { animation(g)["channels"][0]["sampler"] = 5; }, "/animations/0/channels/0/sampler");
  refused([](Gltf& g) { animation(g)["channels"][0]["target"]["node"] = 5; }, "/animations/0/channels/0/target/node");
  refused([](Gltf& g) { animation(g)["samplers"][0]["output"] = animation(g)["samplers"][1]["output"]; }, "format");
  refused([](Gltf& g) { animation(g)["samplers"][0]["interpolation"] = "CUBICSPLINE"; }, "length");
  refused(
      [](Gltf& g) {
        animation(g)["samplers"][0]["input"] = g.accessor(std::vector<float>{0, 2, 1}, "SCALAR", kFloat, true);
      },
      "increase");
  refused(
      [](Gltf& g) {
        animation(g)["samplers"][0]["input"] = g.accessor(std::vector<float>{0, 1}, "SCALAR", kFloat, true);
      },
      "length");
  refused(
      [](Gltf& g) {
        animation(g)["samplers"][1]["output"] =
            g.accessor(std::vector<float>{0, NAN, 0, 1, 0, 0, 0, 0, 0}, "VEC3", kFloat);
      },
      "finite");
  refused(
      [](Gltf& g) {
        animation(g)["samplers"][1]["output"] =
            g.accessor(std::vector<float>{0, 0, 0, 1e30f, 0, 0, 0, 0, 0}, "VEC3", kFloat);
      },
      "larger than 1e+06");
  refused(
      [](Gltf& g) {
        animation(g)["samplers"][0]["output"] =
            g.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 3, 0, 0, 0, 1}, "VEC4", kFloat);
      },
      "length 3");
}

TEST(Animation, AHugeOneIsRefusedBeforeItIsRead) {
  Gltf gltf = turning();
  std::vector<float> times(300'000), values(900'000, 0.0f);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<float>(i);
  const std::size_t input = gltf.accessor(times, "SCALAR", kFloat, true),
                    output = gltf.accessor(values, "VEC3", kFloat);
  Json& it = animation(gltf);
  it["samplers"] = Json::array({{{"input", input}, {"output", output}}});
  it["channels"] = Json::array();
  for (int n = 0; n < 4; ++n) {
    gltf.json["nodes"].push_back({{"name", "n"}});
    it["channels"].push_back({{"sampler", 0}, {"target", {{"node", n}, {"path", "translation"}}}});
  }
  EXPECT_THAT(gltf.refusal(), HasSubstr("1000000 that are taken"));
}

TEST(Animation, WhatCannotBePlayedIsLeftOutWithANote) {
  Gltf gltf = turning();
  gltf.json["accessors"].push_back({{"componentType", kFloat}, {"type", "VEC3"}, {"count", 3}});  // without data
  animation(gltf)["samplers"][1]["output"] = gltf.json["accessors"].size() - 1;
  const Level level = loaded(gltf);
  EXPECT_EQ(level.animations[0].channels.size(), 1u);
  EXPECT_THAT(level.notes, ::testing::Contains(HasSubstr("no data")));
}

TEST(Animation, AScaleOfWhatCanBeTouchedIsLeftOutAndOfADrawableIsKept) {
  Gltf gltf = turning();
  const std::vector<float> sizes = {1, 1, 1, 2, 2, 2, 1, 1, 1};
  animation(gltf)["samplers"][1]["output"] = gltf.accessor(sizes, "VEC3", kFloat);
  animation(gltf)["channels"][1]["target"]["path"] = "scale";
  Level level = loaded(gltf);
  const World drawn = spawned(level);
  EXPECT_FALSE(motion_of(drawn, "thing").scale.empty());
  EXPECT_FALSE(drawn.registry.has<Pose>(find_by_name(drawn, "thing")));
  make_touchable(level);
  std::vector<std::string> notes;
  const World touched = spawned(level, &notes);
  EXPECT_TRUE(motion_of(touched, "thing").scale.empty());
  EXPECT_THAT(notes, ::testing::Contains(HasSubstr("keeps its size")));
}

// `thing` under `parent`, which has a scale.
Level under(vec3 scale) {
  Level level = loaded(turning());
  make_touchable(level);
  LevelNode parent;
  parent.name = "parent";
  parent.local.scale = scale;
  parent.children = {1};
  level.nodes[0].parent = 0;
  level.nodes.insert(level.nodes.begin(), parent);
  for (LevelChannel& channel : level.animations[0].channels) channel.node = 1;
  return level;
}

TEST(Animation, TurningUnderUnevenScalesIsLeftOutWithANoteAndUnderEvenOnesKept) {
  std::vector<std::string> notes;
  const World even = spawned(under(vec3(2)), &notes);
  EXPECT_FALSE(motion_of(even, "thing").rotation.empty());
  EXPECT_THAT(notes, ::testing::Not(::testing::Contains(HasSubstr("scale"))));
  const World uneven = spawned(under({1, 3, 1}), &notes);
  EXPECT_TRUE(motion_of(uneven, "thing").rotation.empty());
  EXPECT_THAT(notes, ::testing::Contains(HasSubstr("unevenly")));
}

TEST(Animation, KeysOfPliantMotionChooseSlowAndStopIt) {
  Level level = loaded(turning());
  make_touchable(level);
  NodeMotion& motion = level.nodes[0].motion.emplace();
  motion.speed = 0.25;
  motion.repeat = false;
  motion.animation = "turn";
  const World world = spawned(level);
  EXPECT_EQ(motion_of(world, "thing").speed, 0.25);
  EXPECT_FALSE(motion_of(world, "thing").repeats);
  ASSERT_TRUE(set_key(level, "thing.motion.speed=0").ok());
  const World still = spawned(level);
  EXPECT_FALSE(still.registry.has<Kinematic>(find_by_name(still, "thing")));
  level.nodes[0].motion->animation = "trun";
  EXPECT_THAT(spawn_refusal(level), HasSubstr("`trun`, which does not move this node"));
}

TEST(Animation, OfBodiesAFixedRigidOneAloneIsCarried) {
  Level level = loaded(turning());
  level.nodes[0].rigid_body.emplace().fixed = true;
  EXPECT_TRUE(spawn(level).ok());
  level.nodes[0].rigid_body->fixed = false;
  EXPECT_THAT(spawn_refusal(level), HasSubstr("node `thing`"));
  EXPECT_THAT(spawn_refusal(level), HasSubstr("set `fixed`"));
  level.nodes[0].rigid_body.reset();
  level.nodes[0].soft_body.emplace();
  EXPECT_THAT(spawn_refusal(level), HasSubstr("not supported"));
}

class MotionFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("pliant-motion-") + info->name() + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  // A ball moved by a script with this text.
  Level scripted(const std::string& text, const std::string& name = "turn.csv") {
    std::ofstream(folder_ / "turn.csv") << text;
    Level level = level_of(icosphere(1));
    level.path = folder_ / "level.glb";
    level.nodes[0].motion.emplace().script = name;
    return level;
  }
  fs::path folder_;
};

TEST_F(MotionFiles, AScriptMovesTheNodeInItsParentsFrameAndTurnsItOnlyIfItSaysSo) {
  Level level = scripted("time_s,x,y,z\n0,1,0,0\n2,3,0,0\n");
  level.nodes[0].local.rotation = glm::angleAxis(0.5f, vec3(0, 0, 1));
  const World world = spawned(level);
  const PrescribedMotion& motion = motion_of(world, "thing");
  EXPECT_TRUE(motion.rotation.empty());
  const LocalFrame frame = sample_motion(motion, level.nodes[0].local, 1.0);
  EXPECT_EQ(frame.translation, dvec3(2, 0, 0));
  EXPECT_NEAR(frame.rotation.z, std::sin(0.25), 1e-7);
  const World turned = spawned(scripted("time_s,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0,0,0,0,0,1,0\n"));
  EXPECT_FALSE(motion_of(turned, "thing").rotation.empty());
}

TEST_F(MotionFiles, BadScriptsAreRefusedWithASentence) {
  EXPECT_THAT(spawn_refusal(scripted("time_s,x,y,z\n0,0,0,0\n0,1,1,1\n")), HasSubstr("time does not grow"));
  EXPECT_THAT(spawn_refusal(scripted("time_s,x,y,z\n0,0,0,1e9\n1,0,0,0\n")), HasSubstr("outside"));
  EXPECT_THAT(spawn_refusal(scripted("time_s,x,y,z\n-1,0,0,0\n1,0,0,0\n")), HasSubstr("outside"));
  EXPECT_NE(spawn_refusal(scripted("time_s,x,y,z\n0,0,0,0\n", "../turn.csv")), "");
  EXPECT_NE(spawn_refusal(scripted("time_s,x,y,z\n0,0,0,0\n", "none.csv")), "");
}

TEST_F(MotionFiles, SavingKeepsAnimationsWithAndWithoutTheDocumentTheyCameFrom) {
  Gltf gltf = turning();
  gltf.json["nodes"][0]["extensions"]["PLIANT_motion"] = {{"speed", 0.5}};
  gltf.json["extensionsUsed"] = {"PLIANT_motion"};
  Level level = loaded(gltf);
  for (const bool with_source : {true, false}) {
    if (!with_source) level.source = nullptr;
    for (const char* name : {"level.glb", "level.gltf"}) {
      ASSERT_TRUE(save_level(level, folder_ / name).ok());
      const Result<Level> again = load_level(folder_ / name);
      ASSERT_TRUE(again.ok()) << again.error().message();
      EXPECT_EQ(Difference::of(level, *again), "") << name << with_source;
      ASSERT_TRUE(again->nodes[0].motion);
      EXPECT_EQ(again->nodes[0].motion->speed, 0.5);
    }
  }
}

}  // namespace
}  // namespace pliant::test
