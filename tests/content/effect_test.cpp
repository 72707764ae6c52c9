// PLIANT_effect in a file: what is wrong is one sentence, and saving keeps every key.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "content/keys/extension_table.h"
#include "content/keys/unused_keys.h"
#include "content/level_file.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

class EffectFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("pliant-effect-") + info->name() + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  Result<Level> read(const std::string& keys) {
    write("level.gltf",
          R"({"asset": {"version": "2.0"}, "extensionsUsed": ["PLIANT_effect", "PLIANT_probe"], "scene": 0,
"scenes": [{"nodes": [0, 1]}], "nodes": [{"name": "it", "extensions": {"PLIANT_effect": )" +
              keys + R"(}}, {"name": "finger", "extensions": {"PLIANT_probe": {}}}]})");
    return load_level(folder_ / "level.gltf");
  }
  // The error of reading or spawning it; "": none.
  std::string said(const std::string& keys) {
    const Result<Level> level = read(keys);
    if (!level) return level.error().message();
    const Result<World> world = spawn_level(*level);
    return world ? "" : world.error().message();
  }
  fs::path folder_;
};

TEST_F(EffectFile, WhatIsWrongIsOneSentence) {
  write("point.csv", "time_s,x,y,z\n0,1,2,3\n1,1,2,3\n");
  write("line.csv", "time_s,x,y,z\n0,0,0,0\n1,1,2,3\n");
  const auto expect = [&](const std::string& keys, const std::string& part) {
    const std::string message = said(keys);
    EXPECT_NE(message.find(part), std::string::npos) << keys << '\n' << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  expect(R"({"kind": "magnet"})", "must be one of viscosity, gravity, attraction, guidance, forbidden, detents");
  expect(R"({"stifness": 3})", "stiffness");
  expect(R"({"stiffness": -3})", "must be in the range");
  expect(R"({"stiffness": 0})", "must be in the range");
  expect(R"({"stiffness": "nan"})", "must be a number");
  expect(R"({"stiffness": 1e999})", "");
  expect(R"({"edge": 0})", "must be in the range");
  expect(R"({"damping": 1e9})", "must be in the range");
  expect(R"({"force": [0, 1]})", "must be three numbers");
  expect(R"({"size": [-1, 0]})", "must be two numbers in [0, 1000]");
  expect(R"({"kind": "guidance"})", "without a `path`");
  expect(R"({"kind": "guidance", "path": "none.csv"})", "none.csv");
  expect(R"({"kind": "guidance", "path": "point.csv"})", "a single point");
  expect(R"({"kind": "guidance", "path": "../line.csv"})", "../line.csv");
  expect(R"({"kind": "gravity", "region": "box"})", "without a `box`");
  expect(R"({"kind": "forbidden", "region": "everywhere"})", "no probe could be anywhere");
  expect(R"({"kind": "detents", "detents": "around", "count": 2.5})", "whole number");
  expect(R"({"probes": "finger"})", "a list of at most 64 names");
  expect(R"({"probes": ["finger", ""]})", "a list of at most 64 names");
  expect(R"({"probes": ["fingr"]})", "names 'fingr', which is no node with a PLIANT_probe; did you mean finger?");
  expect(R"({"probes": ["it"]})", "which is no node with a PLIANT_probe");
  EXPECT_FALSE(said(R"({"stiffness": 1e999})").empty());
  EXPECT_EQ(said(R"({"kind": "guidance", "path": "line.csv"})"), "");
  EXPECT_EQ(said("{}"), "");
}

TEST_F(EffectFile, EverySavedKeyIsReadAgain) {
  const Result<Level> level = read(
      R"({"kind": "detents", "region": "box", "radius": 0.25, "box": {"min": [-1, -2, -3], "max": [1, 2, 3.5]},
"edge": 0.125, "damping": 0.5, "force": [1, 2, -3], "target": "plane", "length": 0.5, "size": [0.25, 0.5],
"stiffness": 12.5, "range": 0.0625, "path": "line.csv", "detents": "around", "spacing": 0.5, "count": 7, "peak": 0.25,
"probes": ["finger"]})");
  ASSERT_TRUE(level.ok()) << level.error().message();
  ASSERT_TRUE(save_level(*level, folder_ / "saved.gltf").ok());
  const Result<Level> again = load_level(folder_ / "saved.gltf");
  ASSERT_TRUE(again.ok()) << again.error().message();
  const Extension& extension = *find_extension("effect");
  LevelNode fresh;
  extension.add(&fresh);
  for (const Key& key : extension.keys) {
    EXPECT_EQ(key.get(&level->nodes[0]), key.get(&again->nodes[0])) << key.name;
    EXPECT_NE(key.get(&fresh), key.get(&again->nodes[0])) << key.name << ": this test says something else";
  }
}

// In single precision 0.1 would come back as 0.10000000149.
TEST_F(EffectFile, ABoxComesBackAsItWasWritten) {
  Result<Level> level =
      read(R"({"kind": "forbidden", "region": "box", "box": {"min": [-0.1, -0.2, -0.3], "max": [0.1, 0.2, 0.7]}})");
  ASSERT_TRUE(level.ok()) << level.error().message();
  EXPECT_EQ(level->nodes[0].effect->box, (DBox{{-0.1, -0.2, -0.3}, {0.1, 0.2, 0.7}}));
  level->nodes[0].effect->stiffness = 77.0;  // the extension is written anew
  ASSERT_TRUE(save_level(*level, folder_ / "saved.gltf").ok());
  const Result<Level> again = load_level(folder_ / "saved.gltf");
  ASSERT_TRUE(again.ok()) << again.error().message();
  EXPECT_EQ(again->nodes[0].effect->box, level->nodes[0].effect->box);
}

TEST_F(EffectFile, OneNumberOfAForcePointsDown) {
  const Result<Level> level = read(R"({"kind": "gravity", "force": 0.5})");
  ASSERT_TRUE(level.ok());
  EXPECT_EQ(level->nodes[0].effect->force, dvec3(0, -0.5, 0));
}

TEST_F(EffectFile, AKeyThatItsKindDoesNotReadIsSaid) {
  const auto unused = [&](const std::string& keys) {
    const Result<Level> level = read(keys);
    std::string all;
    if (level)
      for (const UnusedKey& key : find_unused_keys(*level)) all += key.pointer + ' ';
    return all;
  };
  EXPECT_EQ(unused(R"({"kind": "viscosity", "damping": 3, "stiffness": 3})"), "PLIANT_effect/stiffness ");
  EXPECT_EQ(unused(R"({"kind": "attraction", "length": 0.3})"), "PLIANT_effect/length ");
  EXPECT_EQ(unused(R"({"kind": "attraction", "target": "segment", "length": 0.3})"), "");
  EXPECT_EQ(unused(R"({"kind": "detents", "region": "everywhere", "edge": 0.3})"), "PLIANT_effect/edge ");
  EXPECT_EQ(unused(R"({"kind": "detents", "region": "everywhere", "edge": 0.3, "detents": "around", "count": 3})"), "");
  EXPECT_EQ(unused(R"({"kind": "forbidden", "radius": 0.3, "force": 2})"), "PLIANT_effect/force ");
}

}  // namespace
}  // namespace pliant::test
