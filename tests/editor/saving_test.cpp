// A level that could not be opened again is never saved; 0 means unset for all keys where the table says so.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "content/keys/extension_table.h"
#include "content/validate.h"
#include "editor/document/edits.h"
#include "editor/document/stated_keys.h"
#include "tests/editor/small_level.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using testing::id_of;
using testing::OwnFolder;

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

Document small(const fs::path& file) {
  EXPECT_TRUE(save_level(testing::sheet_and_finger(), file).ok());
  Result<Document> document = Document::open(file);
  EXPECT_TRUE(document.ok());
  return *std::move(document);
}

TEST(Saving, AModulusOfZeroBesideAStiffnessIsNotGiven) {
  const OwnFolder folder("saving_young");
  const fs::path file = folder.path / "small.glb";
  Document document = small(file);
  const NodeId sheet = id_of(document, "sheet");
  ASSERT_TRUE(document.change("a", with_stated(document.state(), sheet, {{"deformable", "stiffness", 200.0}})).ok());
  ASSERT_TRUE(document.change("b", with_stated(document.state(), sheet, {{"deformable", "young", 5e3}})).ok());
  // A material is pressed.
  ASSERT_TRUE(document
                  .change("c", by_level(document.state(), document.next_id(),
                                        [](Level& level) -> Status {
                                          level.nodes[0].deformable->young = 0.0;
                                          level.nodes[0].deformable->stiffness = 123.0;
                                          return Done{};
                                        }))
                  .ok());
  ASSERT_TRUE(document.save().ok());
  const Result<Document> again = Document::open(file);
  ASSERT_TRUE(again.ok()) << again.error().message();
  EXPECT_EQ(again->state().find("sheet")->node.deformable->stiffness, 123.0);
  EXPECT_EQ(again->state().find("sheet")->node.deformable->young, 0.0);
  EXPECT_FALSE(any_error(validate_level(file)));
  // An older file that contains the key.
  LevelNode node;
  EXPECT_TRUE(
      parse_node_extensions(Json{{"PLIANT_deformable", {{"young", 0.0}, {"stiffness", 50.0}}}}, "", {}, node).ok());
  EXPECT_EQ(node.deformable->stiffness, 50.0);
  EXPECT_FALSE(
      parse_node_extensions(Json{{"PLIANT_deformable", {{"young", 9.0}, {"stiffness", 50.0}}}}, "", {}, node).ok());
}

// Values that a user might set a key to.
std::vector<Json> values_of(const Key& key) {
  std::vector<Json> all;
  const double low = std::max(key.range.min, -1e6), high = std::min(key.range.max, 1e6);
  const double middle =
      std::isfinite(key.usual.min) ? 0.5 * (key.usual.min + std::min(key.usual.max, 1e6)) : 0.5 * (low + high);
  switch (key.type) {
    case KeyType::kNumber:
    case KeyType::kNumberOrMaterial:
      for (const double each : {0.0, low, high, middle}) all.push_back(each);
      if (key.type == KeyType::kNumberOrMaterial) all.push_back("material");
      break;
    case KeyType::kFlag:
      all = {true, false};
      break;
    case KeyType::kText:
    case KeyType::kNode:
      all = {"", "finger", "a name.csv", "\xff not utf-8"};
      break;
    case KeyType::kChoice:
      for (const std::string& each : key.choices()) all.push_back(each);
      break;
    case KeyType::kColor:
    case KeyType::kVector:
      all = {Json{0.0, 0.0, 0.0}, Json{low, middle, high}};
      break;
    case KeyType::kPair:
      all = {Json{0.0, 0.0}, Json{low, high}};
      break;
    case KeyType::kPoints:
      all = {Json::array(), Json{{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}}};
      break;
    case KeyType::kNames:
      all = {Json::array(), Json{"finger"}, Json{"finger", "a second one"}};
      break;
    case KeyType::kItems:
      all = {Json::array(), Json{{{"force", 1.0}}, {{"name", "fat"}, {"energy", 0.01}, {"grip", 5.0}}},
             Json{{{"force", 0.0}}}};
      break;
    case KeyType::kTable:
      all = {Json::array(), Json{{0.0, 0.0}, {0.001, 0.3}, {0.002, 0.8}}};
      break;
    case KeyType::kBox:
      all = {Json{{"min", {0.0, 0.0, 0.0}}, {"max", {0.1, 0.1, 0.1}}},
             Json{{"min", {0.0, 0.0, 0.0}}, {"max", {0.0, 0.0, 0.0}}}};
      break;
  }
  return all;
}

TEST(Saving, WhateverAKeyIsSetToIsOpenedAgainOrRefusedInASentence) {
  const OwnFolder folder("saving_keys");
  const fs::path file = folder.path / "small.glb";
  std::size_t saved = 0, refused = 0;
  for (const Extension& extension : extension_table())
    for (const Key& key : extension.keys)
      for (const Json& value : values_of(key)) {
        if (key.alias) continue;
        Document document = small(file);
        const NodeId node = extension.on_scene                                               ? kNoNode
                            : extension.name == "probe" || extension.name == "haptic_device" ? id_of(document, "finger")
                                                                                             : id_of(document, "sheet");
        Result<State> next(document.state());
        if (!extension.on_scene) next = with_component(*next, NodeIds(&node, 1), extension.name);
        ASSERT_TRUE(next.ok());
        // As set by a user, and as stated at its default.
        for (const bool said : {false, true}) {
          const Result<State> set = said ? with_stated(*next, node, {{extension.name, key.name, value}})
                                         : with_value(*next, extension.on_scene ? NodeIds() : NodeIds(&node, 1),
                                                      extension.name, key.name, value);
          if (!set || !document.change("set", set)) {
            ++refused;
            continue;
          }
          const std::string before = bytes_of(file);
          if (const Status status = document.save(); !status) {
            ++refused;
            EXPECT_NE(status.error().message().find("; "), std::string::npos) << status.error().message();
            EXPECT_EQ(bytes_of(file), before) << "what is there stays";
            continue;
          }
          ++saved;
          const Result<Document> again = Document::open(file);
          EXPECT_TRUE(again.ok()) << extension.name << '.' << key.name << " = "
                                  << value.dump(-1, ' ', false, Json::error_handler_t::replace) << ": "
                                  << again.error().message();
          // To the default, by the round arrow.
          const Result<State> reset =
              with_default(*set, extension.on_scene ? NodeIds() : NodeIds(&node, 1), extension.name, key.name);
          if (reset && document.change("reset", reset) && document.save()) {
            EXPECT_TRUE(Document::open(file).ok()) << extension.name << '.' << key.name << " reset";
          }
        }
      }
  EXPECT_GT(saved, 300u);
  EXPECT_GT(refused, 3u);
}

TEST(Saving, WhatCannotBeOpenedReplacesNothing) {
  const OwnFolder folder("saving_refused");
  for (const char* name : {"small.glb", "small.gltf"}) {
    const fs::path file = folder.path / name;
    Document document = small(file);
    const std::string before = bytes_of(file);
    const auto in_folder = [&] { return std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()); };
    const auto files = in_folder();
    ScriptKeys keys;
    keys.keys = {{0.0, {0, 0.1, 0}, {0, 1, 0}, 0.0}, {1.0, {0, 0.1, 0}, {0, 1, 0}, 0.01}};
    const NodeId finger = id_of(document, "finger");
    ASSERT_TRUE(document.change("path", with_script(document.state(), finger, "press.csv", keys)).ok());
    // Through an edit that checks nothing: a device that is not there.
    ASSERT_TRUE(document
                    .change("probe", by_level(document.state(), document.next_id(),
                                              [](Level& level) -> Status {
                                                for (LevelNode& node : level.nodes)
                                                  if (node.probe) node.probe_device = "nobody";
                                                return Done{};
                                              }))
                    .ok());
    const Status status = document.save();
    ASSERT_FALSE(status.ok()) << "its probe names a device that is not there";
    EXPECT_NE(status.error().message().find("could not be opened again"), std::string::npos)
        << status.error().message();
    EXPECT_NE(status.error().message().find("; "), std::string::npos) << status.error().message();
    EXPECT_EQ(bytes_of(file), before);
    EXPECT_EQ(in_folder(), files) << "nothing is left behind, no script either";
    document.undo();
    EXPECT_TRUE(document.save().ok());
    EXPECT_TRUE(Document::open(file).ok());
    fs::remove(folder.path / "press.csv");
  }
}

}  // namespace
}  // namespace pliant
