// `layers` and `yield` of PLIANT_deformable in a file: what is wrong is one sentence, and saving keeps every key.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "content/keys/extension_table.h"
#include "content/keys/unused_keys.h"
#include "content/level_file.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

Result<LevelNode> read(const std::string& keys) {
  LevelNode node;
  const Json json{{"PLIANT_deformable", Json::parse(keys)}};
  if (const Status status = parse_node_extensions(json, "file", {}, node); !status) return status.error();
  return node;
}

TEST(LayersKey, WhatIsWrongIsOneSentence) {
  const auto expect = [](const std::string& keys, const std::string& part) {
    const Result<LevelNode> node = read(keys);
    ASSERT_FALSE(node.ok()) << keys;
    const std::string message = node.error().message();
    EXPECT_NE(message.find(part), std::string::npos) << keys << '\n' << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  expect(R"({"layers": {"force": 1}})", "must be a list of at most 8 objects");
  expect(R"({"layers": [1]})", "item 1 must be an object");
  expect(R"({"layers": [{"force": 1}, {"forse": 1}]})", "did you mean force?");
  expect(R"({"layers": [{"force": -1}]})", "item 1: `force` must be in the range [0, 1000] N; got -1");
  expect(R"({"layers": [{"force": 1}, {"force": 1, "thickness": 0}]})", "item 2: `thickness` must be in the range");
  expect(R"({"layers": [{"force": "much"}]})", "item 1: `force` must be a number");
  expect(R"({"layers": [{"name": 3, "force": 1}]})", "item 1: `name` must be a text");
  expect(R"({"layers": [{"stiffness": 500}]})", "layer 1 has neither `force` nor `energy`");
  expect(R"({"layers": [{"force": 1}], "spring": "sls"})", "cannot be combined with the law sls");
  expect(R"({"yield": {"force": 1}, "spring": "sls"})", "yield.force cannot be combined with the law sls");
  expect(R"({"yield": {"force": 1}, "response": "lag"})", "needs a surface that follows the probe");
  expect(R"({"yield": {"force": 1}, "layers": [{"force": 1}]})", "gives both layers and yield.force");
  expect(R"({"layers": [{"force":1},{"force":1},{"force":1},{"force":1},{"force":1},{"force":1},{"force":1},{"force":1},
             {"force":1}]})",
         "at most 8");
}

TEST(LayersKey, SavingKeepsEveryKey) {
  const Json given = Json::parse(R"({"PLIANT_deformable": {"layers": [
      {"name": "skin", "thickness": 0.003, "stiffness": 600.0, "force": 1.2, "remains": 0.1, "grip": 15.0},
      {"name": "ligament", "thickness": 0.005, "stiffness": 900.0, "energy": 0.002}], "hole_radius": 0.004}})");
  LevelNode node;
  ASSERT_TRUE(parse_node_extensions(given, "", {}, node).ok());
  ASSERT_EQ(node.deformable->layers.size(), 2u);
  EXPECT_EQ(node.deformable->layers[0].name, "skin");
  EXPECT_EQ(node.deformable->layers[0].grip, 15.0);
  EXPECT_EQ(node.deformable->layers[1].energy, 0.002);
  EXPECT_EQ(node.deformable->layers[1].force, 0.0);
  Level level;
  node.name = "organ";
  level.nodes = {node};
  const fs::path file = fs::temp_directory_path() / ("pliant-layers-" + std::to_string(::getpid()) + ".gltf");
  ASSERT_TRUE(save_level(level, file).ok());
  const Result<Level> read = load_level(file);
  fs::remove(file);
  ASSERT_TRUE(read.ok()) << read.error().message();
  const Key& key = *find_key(*find_extension("deformable"), "layers");
  EXPECT_EQ(key.get(&read->nodes.at(0)), given["PLIANT_deformable"]["layers"]);
  EXPECT_EQ(read->nodes.at(0).deformable->hole_radius, 0.004);
}

TEST(LayersKey, AnUnusualUnitIsAskedAboutAndAKeyWithoutEffectIsNamed) {
  Result<LevelNode> node = read(R"({"layers": [{"force": 1, "thickness": 4}], "yield": {"hardening": 10}})");
  ASSERT_TRUE(node.ok()) << node.error().message();
  const Key& key = *find_key(*find_extension("deformable"), "layers");
  const std::optional<Note> note = doubt(key, key.get(&*node));
  ASSERT_TRUE(note);
  EXPECT_NE(note->message().find("mm meant? then write 0.004"), std::string::npos) << note->message();
  Level level;
  level.nodes = {*node};
  const std::vector<UnusedKey> unused = find_unused_keys(level);
  ASSERT_EQ(unused.size(), 1u);
  EXPECT_NE(unused[0].what.find("yield.force"), std::string::npos) << unused[0].what;
}

}  // namespace
}  // namespace pliant::test
