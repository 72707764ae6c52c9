// The document: every edit, undone and redone, gives the same bits; saving loses nothing.
#include "editor/document/document.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "content/files/file_io.h"
#include "content/keys/extension_table.h"
#include "content/level_file.h"
#include "editor/document/edits.h"
#include "tests/editor/small_level.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using testing::id_of;

Level small_level() {
  Level level;
  level.name = "small";
  level.meshes.push_back({"sheet", {testing::quad_sheet(70)}});
  LevelNode sheet;
  sheet.name = "sheet";
  sheet.mesh = 0;
  sheet.deformable.emplace();
  LevelNode probe;
  probe.name = "finger";
  probe.probe.emplace();
  probe.device.emplace();
  probe.probe_device = "finger";
  probe.local.translation = {0.05f, 0.05f, 0.05f};
  level.nodes = {sheet, probe};
  return level;
}

struct TemporaryFolder {
  fs::path path = fs::temp_directory_path() / ("pliant_document_" + std::to_string(::getpid()));
  TemporaryFolder() { fs::create_directories(path); }
  ~TemporaryFolder() { fs::remove_all(path); }
};

Document opened(const fs::path& folder) {
  const fs::path file = folder / "small.glb";
  EXPECT_TRUE(save_level(small_level(), file).ok());
  Result<Document> document = Document::open(file);
  EXPECT_TRUE(document.ok()) << document.error().message();
  return *std::move(document);
}

// One edit of any kind; errors are fine, they change nothing.
class RandomEdits {
 public:
  RandomEdits(Document& document, unsigned seed) : document_(document), random_(seed) {}

  Status one() {
    const State& s = document_.state();
    const std::vector<NodeId> ids = some();
    const NodeId id = ids.empty() ? kNoNode : ids.front();
    switch (below(14)) {
      case 0:
        return document_.change("rename", renamed(s, id, std::string(1, static_cast<char>('a' + below(26)))));
      case 1: {
        LocalTransform local;
        local.translation = vec3(number(), number(), number());
        local.rotation = glm::normalize(quat(1.0f, number(), number(), number()));
        local.scale = vec3(0.5f + std::abs(number()));
        return document_.change("place", placed(s, id, local), below(2) ? "gesture" : "");
      }
      case 2:
        return document_.change("duplicate", duplicated(s, ids, document_.next_id()));
      case 3:
        return s.nodes.size() > 12 ? document_.change("delete", without(s, ids)) : Done{};
      case 4:
        return document_.change("reparent", reparented(s, ids, below(3) ? pick() : kNoNode));
      case 5: {
        const auto& table = extension_table();
        return document_.change("add", with_component(s, ids, table[below(table.size())].name));
      }
      case 6: {
        const auto& table = extension_table();
        return document_.change("remove", without_component(s, ids, table[below(table.size())].name));
      }
      case 7:
        return document_.change(
            "value", with_value(s, ids, "deformable", "stiffness", 1.0 + 1000.0 * std::abs(number())), "stiffness");
      case 8:
        return document_.change(
            "value", with_value(s, ids, "simulation", "touch_rate", 500.0 + 100.0 * static_cast<double>(below(9))));
      case 9: {
        LevelNode node;
        node.name = "new";
        return document_.change("new", with_node(s, document_.new_id(), below(2) ? pick() : kNoNode, node));
      }
      case 10: {
        if (s.meshes.empty()) return Done{};
        const LayerKey key{0, 0, kChannels[below(6)]};
        const std::size_t count = s.meshes[0]->primitives[0].position.size();
        const auto it = s.paint.find(key);
        PaintLayer layer = it == s.paint.end() ? PaintLayer::constant(count, unpainted(key.channel)) : it->second;
        std::vector<IndexedValue> values;
        const std::size_t first = below(count);
        for (std::size_t i = first; i < std::min(count, first + 40); ++i)
          values.push_back({static_cast<std::uint32_t>(i), is_share(key.channel) ? 1.0f : 2.0f + number()});
        return document_.change("paint", with_layer(s, key, layer.with(values)));
      }
      case 11:
        return document_.change("clear", without_layer(s, 0, kChannels[below(6)]));
      case 12:
        return document_.change("light", with_light(s, id, below(2) ? std::optional(Light{}) : std::nullopt));
      default:
        return document_.change("reset", with_default(s, ids, "deformable", "stiffness"));
    }
  }

  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

 private:
  float number() { return std::uniform_real_distribution<float>(-1.0f, 1.0f)(random_); }
  NodeId pick() {
    const auto& nodes = document_.state().nodes;
    return nodes.empty() ? kNoNode : nodes[below(nodes.size())]->id;
  }
  std::vector<NodeId> some() {
    std::vector<NodeId> ids;
    for (std::size_t n = 1 + below(2); n-- > 0;)
      if (const NodeId id = pick(); id != kNoNode) ids.push_back(id);
    return ids;
  }
  Document& document_;
  std::mt19937 random_;
};

// A copy that shares nothing, so that a change in a shared part would show.
struct Twin {
  Level level;
  std::vector<NodeId> ids, parents;
  explicit Twin(const State& state) : level(level_of(state)) {
    for (const auto& each : state.nodes) {
      ids.push_back(each->id);
      parents.push_back(each->parent);
    }
  }
};

void expect_same(const Twin& twin, const State& state) {
  const Level level = level_of(state);
  ASSERT_EQ(twin.level.nodes.size(), level.nodes.size());
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode &a = twin.level.nodes[i], &b = level.nodes[i];
    ASSERT_EQ(twin.ids[i], state.nodes[i]->id);
    ASSERT_EQ(twin.parents[i], state.nodes[i]->parent);
    ASSERT_EQ(a.name, b.name);
    ASSERT_EQ(a.parent, b.parent);
    ASSERT_EQ(a.children, b.children);
    ASSERT_EQ(a.mesh, b.mesh);
    ASSERT_EQ(a.local.translation, b.local.translation);
    ASSERT_EQ(a.local.rotation, b.local.rotation);
    ASSERT_EQ(a.local.scale, b.local.scale);
    ASSERT_EQ(a.light.has_value(), b.light.has_value());
    ASSERT_EQ(node_extensions(a, Json()), node_extensions(b, Json()));
  }
  ASSERT_EQ(twin.level.meshes.size(), level.meshes.size());
  for (std::size_t m = 0; m < level.meshes.size(); ++m)
    for (std::size_t p = 0; p < level.meshes[m].primitives.size(); ++p) {
      Primitive a = twin.level.meshes[m].primitives[p], b = level.meshes[m].primitives[p];
      ASSERT_EQ(a.position, b.position);
      ASSERT_EQ(a.index, b.index);
      for (const Channel channel : kChannels) ASSERT_EQ(painted(a, channel), painted(b, channel));
    }
  ASSERT_EQ(scene_extensions(twin.level, Json()), scene_extensions(level, Json()));
}

TEST(Document, TenThousandRandomCommandsUndoneAndDoneAgainAreTheSameToTheBit) {
  const TemporaryFolder folder;
  Document document = opened(folder.path);
  RandomEdits edits(document, 7);
  std::vector<Twin> twins{Twin(document.state())};  // of the steps 0 to step()
  std::size_t changed = 0, undone = 0;
  for (int n = 0; n < 10'000; ++n) {
    if (edits.below(4) == 0 && document.can_undo()) {
      document.undo();
      ++undone;
    } else if (edits.below(6) == 0 && document.can_redo()) {
      document.redo();
    } else {
      const std::uint64_t revision = document.revision();
      (void)edits.one();
      if (document.revision() != revision) {
        ++changed;
        twins.resize(std::min(twins.size(), document.step()), Twin(document.state()));
        twins.emplace_back(document.state());
      }
      if (edits.below(9) == 0) document.end_gesture();
    }
    ASSERT_EQ(twins.size() > document.step(), true);
    if (n % 97 == 0 || n > 9'990) {
      expect_same(twins[document.step()], document.state());
      if (::testing::Test::HasFatalFailure()) return;
    }
    if (twins.size() > 400) {  // begin again, so that the twins fit
      ASSERT_TRUE(document.save_as(folder.path / "small.glb").ok());
      Result<Document> again = Document::open(folder.path / "small.glb");
      ASSERT_TRUE(again.ok()) << again.error().message();
      document = *std::move(again);
      twins.assign(1, Twin(document.state()));
    }
  }
  EXPECT_GT(changed, 3'000u);
  EXPECT_GT(undone, 1'000u);
  while (document.can_undo()) document.undo();
  expect_same(twins.front(), document.state());
}

TEST(Document, SavingWhatWasLoadedTwiceGivesTheSameBytes) {
  const TemporaryFolder folder;
  Document document = opened(folder.path);
  RandomEdits edits(document, 11);
  for (int n = 0; n < 60; ++n) (void)edits.one();
  const fs::path first = folder.path / "first.glb", second = folder.path / "second.glb";
  ASSERT_TRUE(document.save_copy(first).ok());
  Result<Document> again = Document::open(first);
  ASSERT_TRUE(again.ok()) << again.error().message();
  EXPECT_FALSE(again->dirty());
  ASSERT_TRUE(again->save_copy(second).ok());
  EXPECT_EQ(*read_file(first), *read_file(second));
}

TEST(Document, WhatOtherToolsWroteSurvivesEveryEdit) {
  const TemporaryFolder folder;
  const fs::path file = folder.path / "tools.gltf";
  std::ofstream(file) << R"({"asset":{"version":"2.0","extras":{"maker":"another tool"}},
    "extensionsUsed":["VENDOR_thing"],"scene":0,"scenes":[{"nodes":[0,1],"extras":{"mood":"calm"}}],
    "nodes":[{"name":"a","extras":{"note":"keep me"},"extensions":{"VENDOR_thing":{"deep":[1,2,{"x":null}]}}},
             {"name":"b","children":[2]},{"name":"c","extras":7}]})";
  Result<Level> level = load_level(file);
  ASSERT_TRUE(level.ok()) << level.error().message();
  NodeId next = 1;
  State state = state_of(*std::move(level), next);
  const NodeId b = state.find("b")->id, c = state.find("c")->id, a = state.find("a")->id;
  const NodeId bs[] = {b}, cs[] = {c};
  Result<State> after = reparented(state, cs, a);
  ASSERT_TRUE(after.ok());
  after = without(*after, bs);
  ASSERT_TRUE(after.ok());
  after = renamed(*after, a, "renamed");
  ASSERT_TRUE(after.ok());
  const fs::path out = folder.path / "out.gltf";
  ASSERT_TRUE(save_state(*after, out).ok());
  const Result<Bytes> bytes = read_file(out);
  const Json json = Json::parse(bytes->begin(), bytes->end());
  EXPECT_EQ(json["asset"]["extras"]["maker"], "another tool");
  EXPECT_EQ(json["scenes"][0]["extras"]["mood"], "calm");
  ASSERT_EQ(json["nodes"].size(), 2u);
  const Json& kept = json["nodes"][0];
  EXPECT_EQ(kept["name"], "renamed");
  EXPECT_EQ(kept["extras"]["note"], "keep me");
  EXPECT_EQ(kept["extensions"]["VENDOR_thing"]["deep"][2]["x"], nullptr);
  EXPECT_EQ(json["nodes"][1]["extras"], 7);
  EXPECT_EQ(kept["children"], Json::array({1}));
}

TEST(Document, AGestureIsOneStepAndEndsWithTheHand) {
  const TemporaryFolder folder;
  Document document = opened(folder.path);
  const NodeId ids[] = {id_of(document, "sheet")};
  for (int n = 1; n <= 5; ++n)
    ASSERT_TRUE(
        document.change("stiffness", with_value(document.state(), ids, "deformable", "stiffness", 100.0 * n), "drag")
            .ok());
  EXPECT_EQ(document.step_count(), 2u);
  document.end_gesture();
  ASSERT_TRUE(
      document.change("stiffness", with_value(document.state(), ids, "deformable", "stiffness", 900.0), "drag").ok());
  EXPECT_EQ(document.step_count(), 3u);
  document.undo();
  EXPECT_EQ(value_of_key(document.state(), ids[0], "deformable", "stiffness"), 500.0);
  document.undo();
  EXPECT_EQ(value_of_key(document.state(), ids[0], "deformable", "stiffness"), 300.0);
  EXPECT_FALSE(document.dirty());
}

TEST(Document, AnEditThatCannotBeSaysWhyAndChangesNothing) {
  const TemporaryFolder folder;
  Document document = opened(folder.path);
  const NodeId sheet = id_of(document, "sheet"), finger = id_of(document, "finger");
  const NodeId sheets[] = {sheet};
  const std::uint64_t before = document.revision();
  EXPECT_FALSE(document.change("", renamed(document.state(), sheet, "finger")).ok());
  EXPECT_FALSE(document.change("", with_value(document.state(), sheets, "deformable", "stiffness", -1.0)).ok());
  EXPECT_FALSE(document.change("", with_value(document.state(), sheets, "deformable", "stifness", 1.0)).ok());
  EXPECT_FALSE(document.change("", with_value(document.state(), sheets, "deformable", "stiffness", "soft")).ok());
  EXPECT_FALSE(document.change("", reparented(document.state(), sheets, sheet)).ok());
  EXPECT_FALSE(document.change("", with_light(document.state(), 999, Light{})).ok());
  LocalTransform flat;
  flat.scale.y = 0;
  EXPECT_FALSE(document.change("", placed(document.state(), finger, flat)).ok());
  EXPECT_EQ(document.revision(), before);
  EXPECT_EQ(document.step_count(), 1u);
}

TEST(Document, ReferencesFollowANameAndCopiesReferToTheirOwn) {
  const TemporaryFolder folder;
  Document document = opened(folder.path);
  const NodeId finger = id_of(document, "finger");
  ASSERT_TRUE(document.change("rename", renamed(document.state(), finger, "thumb")).ok());
  EXPECT_EQ(document.state().find(finger)->node.probe_device, "thumb");
  std::vector<NodeId> copies;
  const NodeId ids[] = {finger};
  ASSERT_TRUE(document.change("copy", duplicated(document.state(), ids, document.next_id(), &copies)).ok());
  ASSERT_EQ(copies.size(), 1u);
  EXPECT_EQ(document.state().find(copies[0])->node.name, "thumb 2");
  EXPECT_EQ(document.state().find(copies[0])->node.probe_device, "thumb 2");
}

TEST(Document, ADeletedProbeLeavesTheListsOfEffectsButNotAsTheLast) {
  const TemporaryFolder folder;
  Document document = opened(folder.path);
  const NodeId finger = id_of(document, "finger");
  std::vector<NodeId> copies;
  const NodeId ids[] = {finger};
  ASSERT_TRUE(document.change("copy", duplicated(document.state(), ids, document.next_id(), &copies)).ok());
  const NodeId magnet = document.next_id()++;
  LevelNode node;
  node.name = "magnet";
  node.effect.emplace().probes = {"finger", "finger 2"};
  ASSERT_TRUE(document.change("add", with_node(document.state(), magnet, kNoNode, node)).ok());
  using Names = std::vector<std::string>;
  ASSERT_TRUE(document.change("delete", without(document.state(), ids)).ok());
  EXPECT_EQ(document.state().find(magnet)->node.effect->probes, Names{"finger 2"});
  ASSERT_TRUE(document.change("delete", without(document.state(), copies)).ok());
  EXPECT_EQ(document.state().find(magnet)->node.effect->probes, Names{"finger 2"});
}

TEST(Document, MovingInTheTreeKeepsThePlaceInTheWorld) {
  const TemporaryFolder folder;
  Document document = opened(folder.path);
  const NodeId sheet = id_of(document, "sheet"), finger = id_of(document, "finger");
  LocalTransform turned;
  turned.translation = {1, 2, 3};
  turned.rotation = glm::normalize(quat(1.0f, 0.3f, -0.2f, 0.4f));
  turned.scale = vec3(2.0f);
  ASSERT_TRUE(document.change("place", placed(document.state(), sheet, turned)).ok());
  const dmat4 before = document.state().to_world(finger);
  const NodeId ids[] = {finger};
  ASSERT_TRUE(document.change("parent", reparented(document.state(), ids, sheet)).ok());
  const dmat4 after = document.state().to_world(finger);
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(before[c][r], after[c][r], 1e-6);
}

TEST(Document, AStrokeOnALargeMeshCostsWhatItTouches) {
  NodeId next = 1;
  Level level = small_level();
  level.meshes[0].primitives[0] = testing::quad_sheet(400);  // 160,801 vertices
  State state = state_of(std::move(level), next);
  const std::size_t count = state.meshes[0]->primitives[0].position.size();
  const LayerKey key{0, 0, Channel::kStiffness};
  Result<State> one = with_layer(state, key, PaintLayer::constant(count, 1.0f));
  ASSERT_TRUE(one.ok());
  const IndexedValue values[] = {{50'000, 2.0f}, {50'001, 2.0f}};
  Result<State> two = with_layer(*one, key, one->paint.at(key).with(values));
  ASSERT_TRUE(two.ok());
  EXPECT_EQ(one->meshes[0].get(), two->meshes[0].get());
  EXPECT_LE(two->paint.at(key).bytes_not_shared_with(one->paint.at(key)), PaintLayer::kChunk * sizeof(float));
}

TEST(Document, AnEditOfTheWholeLevelSharesWhatItLeavesAlone) {
  NodeId next = 1;
  const State state = state_of(small_level(), next);
  const NodeId before = next;
  Result<State> after = by_level(state, next, [](Level& level) -> Status {
    LevelNode lamp;
    lamp.name = "lamp";
    lamp.light.emplace();
    level.nodes.push_back(lamp);
    level.nodes[0].deformable->stiffness = 77.0;
    return Done{};
  });
  ASSERT_TRUE(after.ok()) << after.error().message();
  EXPECT_EQ(after->meshes[0].get(), state.meshes[0].get());
  EXPECT_EQ(after->nodes[1]->id, state.nodes[1]->id);
  EXPECT_EQ(after->find("lamp")->id, before);
  EXPECT_EQ(next, before + 1);
  EXPECT_EQ(after->nodes[0]->node.deformable->stiffness, 77.0);
  EXPECT_EQ(after->rest.get(), state.rest.get());
}

TEST(Document, APathIsSavedAsAScriptBesideTheLevelAndComesBackAsItsKeys) {
  const TemporaryFolder folder;
  Document document = opened(folder.path);
  const NodeId finger = id_of(document, "finger");
  ScriptKeys keys;
  keys.keys = {{0.0, {0.05, 0, 0.05}, {0, 1, 0}, 0.02}, {1.0, {0.05, 0, 0.05}, {0, 1, 0}, -0.004}};
  ASSERT_TRUE(document.change("path", with_script(document.state(), finger, "press.csv", keys)).ok());
  EXPECT_EQ(document.state().find(finger)->node.device->driver, DriverKind::kScript);
  EXPECT_FALSE(document.change("path", with_script(document.state(), finger, "../press.csv", keys)).ok());
  ASSERT_TRUE(document.save().ok());
  Result<Document> again = Document::open(document.file());
  ASSERT_TRUE(again.ok()) << again.error().message();
  ASSERT_TRUE(again->state().scripts.contains("press.csv"));
  EXPECT_EQ(*again->state().scripts.at("press.csv"), keys);
  again->undo();
  // A script that is as it was is not written again.
  const auto time = fs::last_write_time(folder.path / "press.csv");
  ASSERT_TRUE(again->save().ok());
  EXPECT_EQ(fs::last_write_time(folder.path / "press.csv"), time);
}

TEST(Document, ABareMeshHasNoFileSoThatSavingAsksForOne) {
  const TemporaryFolder folder;
  const fs::path file = folder.path / "bare.obj";
  std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  Result<Document> document = Document::open(file, 0.001);
  ASSERT_TRUE(document.ok()) << document.error().message();
  EXPECT_TRUE(document->file().empty());
  EXPECT_TRUE(document->dirty());
  EXPECT_FALSE(document->save().ok());
  EXPECT_NEAR(document->state().nodes[0]->node.local.scale.x, 0.001f, 1e-9f);
}

}  // namespace
}  // namespace pliant
