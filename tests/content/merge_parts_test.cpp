// Single edits of a level from glTF: what of its document changes, and what stays.
#include "content/author/edit_nodes.h"
#include "tests/content/gltf_builder.h"
#include "tests/content/merge_fixture.h"

namespace pliant::test {
namespace {

// Three nodes in a row and a separate one; an animation moves two of them; a skin uses the last two.
Gltf row() {
  Gltf gltf;
  const std::size_t position = gltf.positions(kSquare);
  gltf.json["meshes"] = Json::array({{{"primitives", Json::array({{{"attributes", {{"POSITION", position}}}}})}}});
  gltf.json["nodes"] = Json::array({{{"children", {1}}, {"extras", {{"tag", 0}}}},
                                    {{"children", {2}}, {"mesh", 0}, {"extras", {{"tag", 1}}}},
                                    {{"mesh", 0}, {"extras", {{"tag", 2}}}},
                                    {{"extras", {{"tag", 3}}}}});
  gltf.json["scenes"] = Json::array({{{"nodes", {0}}}, {{"nodes", {3, 0}}}});
  gltf.json["scene"] = 0;
  const std::size_t times = gltf.accessor(std::vector<float>{0, 1}, "SCALAR", kFloat, true),
                    moves = gltf.accessor(std::vector<float>{0, 0, 0, 1, 0, 0}, "VEC3", kFloat),
                    others = gltf.accessor(std::vector<float>{0, 0, 0, 0, 1, 0}, "VEC3", kFloat);
  gltf.json["animations"] = Json::array(
      {{{"samplers", Json::array({{{"input", times}, {"output", moves}}, {{"input", times}, {"output", others}}})},
        {"channels",
         Json::array({{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
                      {{"sampler", 1}, {"target", {{"node", 3}, {"path", "translation"}}}},
                      {{"sampler", 1},
                       {"target",
                        {{"path", "pointer"},
                         {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/3/scale"}}}}}}}}})}}});
  gltf.json["extensionsUsed"] = {"KHR_animation_pointer"};
  return gltf;
}

TEST_F(MergeTest, ARemovedNodeLeavesNoReferenceBehind) {
  Result<Level> level = row().load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  std::int32_t gone = -1;
  for (std::size_t i = 0; i < level->nodes.size(); ++i)
    if (level->nodes[i].source == 1) gone = static_cast<std::int32_t>(i);
  remove_node(*level, gone);
  const Json json = again(*level).source->json;
  ASSERT_EQ(json["nodes"].size(), 2u);
  EXPECT_FALSE(json["nodes"][0].contains("children"));
  EXPECT_EQ(json["nodes"][1]["extras"]["tag"], 3);
  EXPECT_EQ(json["scenes"][1]["nodes"], Json::array({1, 0}));
  const Json& animation = json["animations"][0];
  ASSERT_EQ(animation["channels"].size(), 2u);
  EXPECT_EQ(animation["samplers"].size(), 1u);
  EXPECT_EQ(animation["channels"][0]["target"]["node"], 1);
  EXPECT_EQ(animation["channels"][1]["target"]["extensions"]["KHR_animation_pointer"]["pointer"], "/nodes/1/scale");
  EXPECT_FALSE(json.contains("meshes")) << "nobody shows it any more";
  EXPECT_EQ(json["accessors"].size(), 2u) << "the square's positions and the first track are gone";
}

TEST_F(MergeTest, ANodeWithoutANameKeepsTheNameItWasCalledByWhenNumbersChange) {
  Gltf gltf;
  gltf.json["nodes"] = Json::array({Json::object(), Json::object(), Json::object()});
  gltf.json["scenes"] = Json::array({{{"nodes", {0, 1, 2}}}});
  Result<Level> level = gltf.load();
  ASSERT_TRUE(level.ok());
  ASSERT_EQ(level->nodes[2].name, "node_2");
  EXPECT_FALSE(again(*level).source->json["nodes"][2].contains("name")) << "nothing has changed";
  remove_node(*level, 0);
  EXPECT_EQ(again(*level).nodes[1].name, "node_2");
}

TEST_F(MergeTest, PaintGoesBesideWhateverFormThePrimitiveHas) {
  Gltf gltf;
  // A strip of quantised positions, sparse friction, and stiffness in an interleaved view of its own.
  const std::vector<std::int16_t> corners = {0, 0, 0, 0, 10, 0, 0, 0, 0, 10, 0, 0, 10, 10, 0, 0};
  const std::size_t view = gltf.view(corners);
  gltf.json["bufferViews"][view]["byteStride"] = 8;
  gltf.json["accessors"].push_back({{"bufferView", view},
                                    {"componentType", kShort},
                                    {"type", "VEC3"},
                                    {"count", 4},
                                    {"min", {0, 0, 0}},
                                    {"max", {10, 10, 0}}});
  const std::size_t position = gltf.json["accessors"].size() - 1;
  const std::size_t at = gltf.view(std::vector<std::uint16_t>{2}), value = gltf.view(std::vector<float>{5.0f});
  gltf.json["accessors"].push_back({{"componentType", kFloat},
                                    {"type", "SCALAR"},
                                    {"count", 4},
                                    {"sparse",
                                     {{"count", 1},
                                      {"indices", {{"bufferView", at}, {"componentType", kUnsignedShort}}},
                                      {"values", {{"bufferView", value}}}}}});
  const std::size_t friction = gltf.json["accessors"].size() - 1;
  Json& primitive = gltf.primitive({{"POSITION", position}, {"_FRICTION", friction}});
  primitive["mode"] = 5;
  gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  Result<Level> level = gltf.load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  Primitive& painted = level->meshes[0].primitives[0];
  ASSERT_EQ(painted.friction, std::vector<float>({0, 0, 5, 0}));
  painted.stiffness = {1, 2, 3, 4};
  const Level one = again(*level);
  EXPECT_EQ(difference(*level, one), "");
  EXPECT_EQ(one.source->json["meshes"][0]["primitives"][0]["mode"], 5);
  EXPECT_EQ(one.source->json["meshes"][0]["primitives"][0]["attributes"]["POSITION"], position);
  EXPECT_EQ(one.source->json["meshes"][0]["primitives"][0]["attributes"]["_FRICTION"], friction);
  painted.friction = {1, 1, 1, 2};
  painted.stiffness.clear();
  const Level two = again(*level);
  EXPECT_EQ(difference(*level, two), "");
  EXPECT_FALSE(two.source->json["meshes"][0]["primitives"][0]["attributes"].contains("_STIFFNESS"));
}

TEST_F(MergeTest, ACompressedPrimitiveStaysCompressedWhenItIsPainted) {
  Level level;
  Primitive sheet;
  for (std::uint32_t i = 0; i < 100; ++i) {
    sheet.position.emplace_back(static_cast<float>(i % 10), static_cast<float>(i / 10),
                                0.01f * static_cast<float>(i * i % 7));
    sheet.stiffness.push_back(1.0f);
  }
  for (std::uint32_t j = 0; j < 9; ++j)
    for (std::uint32_t i = 0; i < 9; ++i) {
      const std::uint32_t a = 10 * j + i;
      sheet.index.insert(sheet.index.end(), {a, a + 1, a + 10, a + 10, a + 1, a + 11});
    }
  level.meshes.push_back({"sheet", {sheet}});
  level.nodes.resize(1);
  level.nodes[0].name = "sheet";
  level.nodes[0].mesh = 0;
  ASSERT_TRUE(save_level(level, folder_ / "small.glb", {16}).ok());
  Result<Level> small = load_level(folder_ / "small.glb");
  ASSERT_TRUE(small.ok());
  Primitive& painted = small->meshes[0].primitives[0];
  painted.damping.clear();
  painted.handle.clear();
  for (std::size_t v = 0; v < painted.position.size(); ++v) {
    painted.stiffness[v] = 1.0f + painted.position[v].x;  // a function of the position, whatever the vertex number
    painted.damping.push_back(painted.position[v].y);
  }
  const Level back = again(*small);
  EXPECT_EQ(difference(*small, back), "");
  const Json& json = back.source->json["meshes"][0]["primitives"][0];
  ASSERT_TRUE(extension_of(json, "KHR_draco_mesh_compression"));
  EXPECT_FALSE(json["extensions"]["KHR_draco_mesh_compression"]["attributes"].contains("_STIFFNESS"));
  const Primitive& read = back.meshes[0].primitives[0];
  for (std::size_t v = 0; v < read.position.size(); ++v) {
    EXPECT_EQ(read.stiffness[v], 1.0f + read.position[v].x);
    EXPECT_EQ(read.damping[v], read.position[v].y);
  }
  // Compressed again, everything is in the Draco data; written plain, nothing is.
  for (const SaveOptions& options : {SaveOptions{12, false, {}}, SaveOptions{0, true, {}}}) {
    ASSERT_TRUE(save_level(*small, folder_ / "other.glb", options).ok());
    Result<Level> other = load_level(folder_ / "other.glb");
    ASSERT_TRUE(other.ok()) << other.error().message();
    EXPECT_EQ(other->meshes[0].primitives[0].damping.size(), painted.damping.size());
  }
}

TEST_F(MergeTest, OneOfTwoNodesThatShareAMeshCanBePaintedAlone) {
  Result<Level> level = row().load();
  ASSERT_TRUE(level.ok());
  level->meshes.push_back(level->meshes[0]);
  level->meshes[1].primitives[0].pinned = {1, 0, 0, 1};
  for (LevelNode& node : level->nodes)
    if (node.source == 2) node.mesh = 1;
  const Level back = again(*level);
  EXPECT_EQ(difference(*level, back), "");
  EXPECT_EQ(back.source->json["meshes"].size(), 2u);
  EXPECT_EQ(back.source->json["meshes"][0]["primitives"][0]["attributes"]["POSITION"],
            back.source->json["meshes"][1]["primitives"][0]["attributes"]["POSITION"]);
}

TEST_F(MergeTest, ALightThatTwoNodesShareIsChangedForOneOfThem) {
  Gltf gltf;
  Json reference = {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
  gltf.json["nodes"] = Json::array({reference, reference});
  gltf.json["scenes"] = Json::array({{{"nodes", {0, 1}}}});
  gltf.json["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] =
      Json::array({{{"type", "point"}, {"name", "lamp"}, {"extras", {{"keep", 1}}}}});
  Result<Level> level = gltf.load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  level->nodes[1].light->intensity = 7.0f;
  Level back = again(*level);
  EXPECT_EQ(difference(*level, back), "");
  const Json& lights = back.source->json["extensions"]["KHR_lights_punctual"]["lights"];
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights[1]["extras"]["keep"], 1);
  back.nodes[0].light.reset();
  back.nodes[1].light->intensity = 8.0f;
  Level last = again(back);
  EXPECT_EQ(difference(back, last), "");
  EXPECT_EQ(last.source->json["extensions"]["KHR_lights_punctual"]["lights"].size(), 1u);
  last.nodes[1].light.reset();
  const Level dark = again(last);
  EXPECT_FALSE(dark.source->json.contains("extensions"));
  EXPECT_FALSE(dark.source->json.contains("extensionsUsed"));
}

TEST_F(MergeTest, ASkinStaysUntilItsJointsMoveAndThenWhatTheLevelShowsIsSaved) {
  const fs::path hand = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid/webxr-hand/right.glb";
  if (!fs::exists(hand)) GTEST_SKIP() << "the corpus is not beside the project";
  Result<Level> level = load_level(hand);
  ASSERT_TRUE(level.ok());
  LevelNode added;
  added.name = "finger";
  added.probe = Probe{};
  add_node(*level, added);
  EXPECT_EQ(difference(*level, again(*level)), "");
  EXPECT_TRUE(again(*level).source->json.contains("skins"));
  std::size_t skinned = 0;
  for (std::size_t i = 0; i < level->nodes.size(); ++i)
    if (level->nodes[i].mesh >= 0 && level->meshes[static_cast<std::size_t>(level->nodes[i].mesh)].skinned >= 0)
      skinned = i;
  const std::int32_t copy = copy_node(*level, static_cast<std::int32_t>(skinned));
  EXPECT_EQ(difference(*level, again(*level)), "") << "the copy shows the hand at rest without a skin";
  level->nodes[static_cast<std::size_t>(copy)].local.translation.x += 0.3f;
  level->nodes[skinned].local.translation.y += 0.2f;
  const Level back = again(*level);
  EXPECT_EQ(difference(*level, back), "");
  for (const Json& node : back.source->json["nodes"]) EXPECT_FALSE(node.contains("skin"));
}

}  // namespace
}  // namespace pliant::test
