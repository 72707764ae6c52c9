// The scene hash of recordings: it covers everything that affects forces, and nothing else.
#include "engine/scene_hash.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>

namespace pliant {
namespace {

namespace fs = std::filesystem;

Level two_plates(const fs::path& folder) {
  Level level;
  level.path = folder / "level.glb";
  for (const float size : {0.1f, 0.2f}) {
    Primitive plate;
    plate.position = {{0, 0, 0}, {0, 0, size}, {size, 0, 0}};
    plate.normal = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
    plate.index = {0, 1, 2};
    level.meshes.push_back({"plate", {plate}});
  }
  for (const char* name : {"root", "pad", "tip"}) level.nodes.emplace_back().name = name;
  level.nodes[1].mesh = 0;
  level.nodes[1].deformable.emplace();
  level.nodes[1].motion = NodeMotion{.script = "way.csv", .animation = ""};
  level.nodes[2].probe.emplace();
  level.nodes[2].device.emplace().file = "tip.csv";
  level.nodes[0].soft_body.emplace().mesh = "organ.node";
  level.animations.push_back({"breath", 2.0, {{0, NodeProperty::kTranslation, {}}}});
  level.animations[0].channels[0].track.times = {0.0, 2.0};
  level.animations[0].channels[0].track.values = {glm::dvec4(0), glm::dvec4(1)};
  return level;
}

class SceneHash : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("pliant-scene-hash-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    for (const char* name : {"way.csv", "tip.csv", "organ.node", "organ.ele"}) write(name, "one");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

  void expect_other(const char* what, const std::function<void(Level&)>& change, bool other = true) {
    Level level = two_plates(folder_);
    const std::uint64_t before = scene_hash(level);
    change(level);
    EXPECT_EQ(scene_hash(level) != before, other) << what;
  }

  fs::path folder_;
};

TEST_F(SceneHash, WhateverIsFeltCounts) {
  expect_other("a vertex", [](Level& l) { l.meshes[0].primitives[0].position[1].x = 0.01f; });
  expect_other("a normal, which makes a crease", [](Level& l) { l.meshes[0].primitives[0].normal[1] = {1, 0, 0}; });
  expect_other("paint", [](Level& l) { l.meshes[0].primitives[0].stiffness = {1, 2, 3}; });
  expect_other("which mesh a node has", [](Level& l) { l.nodes[1].mesh = 1; });
  expect_other("what it hangs on", [](Level& l) { l.nodes[1].parent = 0; });
  expect_other("whether it is in the scene", [](Level& l) { l.nodes[1].in_scene = false; });
  expect_other("its name", [](Level& l) { l.nodes[1].name = "mat"; });
  expect_other("its place", [](Level& l) { l.nodes[1].local.translation.y = 0.1f; });
  expect_other("a key", [](Level& l) { l.nodes[1].deformable->stiffness = 301; });
  expect_other("whose key it is", [](Level& l) { l.nodes[2].deformable.swap(l.nodes[1].deformable); });
  expect_other("the clock", [](Level& l) { l.simulation.touch_rate = 500; });
  expect_other("an animation's name, by which a motion takes it", [](Level& l) { l.animations[0].name = "walk"; });
  expect_other("its length", [](Level& l) { l.animations[0].length = 3.0; });
  expect_other("its node", [](Level& l) { l.animations[0].channels[0].node = 1; });
  expect_other("its values", [](Level& l) { l.animations[0].channels[0].track.values[1].x = 2.0; });
  expect_other("a script of a motion", [this](Level&) { write("way.csv", "two"); });
  expect_other("tetrahedra", [this](Level&) { write("organ.node", "two"); });
  expect_other("TetGen's other file", [this](Level&) { write("organ.ele", "two"); });
}

TEST_F(SceneHash, WhatIsNotFeltDoesNotCount) {
  expect_other(
      "the colour of a probe", [](Level& l) { l.nodes[2].probe->color = vec3(1, 0, 0); }, false);
  expect_other(
      "an error budget", [](Level& l) { l.nodes[1].deformable->error = 0.3; }, false);
  expect_other(
      "a device's script, whose poses are recorded", [this](Level&) { write("tip.csv", "two"); }, false);
  expect_other(
      "a material", [](Level& l) { l.materials.emplace_back(); }, false);
  expect_other(
      "texture coordinates", [](Level& l) { l.meshes[0].primitives[0].uv.assign(3, vec2(0)); }, false);
}

}  // namespace
}  // namespace pliant
