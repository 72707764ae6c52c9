// Triangles in glTF: each case with its known result, and rejected cases.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/content/gltf_builder.h"

namespace pliant::test {
namespace {

using Corners = std::vector<std::uint32_t>;

Primitive only_primitive(const Gltf& gltf) {
  Result<Level> level = gltf.load();
  EXPECT_TRUE(level.ok()) << (level ? "" : level.error().message());
  if (!level || level->meshes.empty() || level->meshes[0].primitives.empty()) return {};
  return level->meshes[0].primitives[0];
}

TEST(Gltf, StripsAndFansBecomeTrianglesOfTheSameOrientation) {
  for (const auto& [mode, expected] : {std::pair{5, Corners{0, 1, 2, 1, 3, 2}}, std::pair{6, Corners{1, 2, 0, 2, 3, 0}},
                                       std::pair{4, Corners{0, 1, 2}}}) {
    Gltf gltf;
    gltf.primitive({{"POSITION", gltf.positions(kSquare)}})["mode"] = mode;
    EXPECT_EQ(only_primitive(gltf).index, expected) << mode;
  }
}

TEST(Gltf, IndicesOfEveryWidthAreTheSameTriangles) {
  const Corners expected = {2, 1, 0, 1, 2, 3};
  Gltf bytes, shorts, ints;
  bytes.primitive({{"POSITION", bytes.positions(kSquare)}})["indices"] =
      bytes.accessor(std::vector<std::uint8_t>{2, 1, 0, 1, 2, 3}, "SCALAR", kUnsignedByte);
  shorts.primitive({{"POSITION", shorts.positions(kSquare)}})["indices"] =
      shorts.accessor(std::vector<std::uint16_t>{2, 1, 0, 1, 2, 3}, "SCALAR", kUnsignedShort);
  ints.primitive({{"POSITION", ints.positions(kSquare)}})["indices"] = ints.accessor(expected, "SCALAR", kUnsignedInt);
  for (const Gltf* gltf : {&bytes, &shorts, &ints}) EXPECT_EQ(only_primitive(*gltf).index, expected);
}

TEST(Gltf, SparseValuesReplaceThoseBelowAndStandOnZerosWithoutAny) {
  for (const bool based : {true, false}) {
    Gltf gltf;
    const std::size_t indices = gltf.view(std::vector<std::uint8_t>{1, 3}),
                      values = gltf.view(std::vector<float>{5, 6, 7, 8, 9, 10});
    Json accessor = {{"componentType", kFloat}, {"type", "VEC3"}, {"count", 4}};
    if (based) accessor["bufferView"] = gltf.view(kSquare);
    accessor["sparse"] = {{"count", 2},
                          {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
                          {"values", {{"bufferView", values}}}};
    accessor["min"] = {0, 0, 0};
    accessor["max"] = {8, 9, 10};
    gltf.json["accessors"].push_back(accessor);
    gltf.primitive({{"POSITION", 0}})["mode"] = 5;
    const Primitive primitive = only_primitive(gltf);
    ASSERT_EQ(primitive.position.size(), 4u);
    EXPECT_EQ(primitive.position[1], vec3(5, 6, 7));
    EXPECT_EQ(primitive.position[3], vec3(8, 9, 10));
    EXPECT_EQ(primitive.position[2], based ? vec3(0, 1, 0) : vec3(0));
  }
}

TEST(Gltf, QuantisedPositionsAndTextureCoordinatesAreScaledAsTheSpecificationSays) {
  Gltf gltf;
  gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const std::size_t position =
      gltf.accessor(std::vector<std::int16_t>{-32768, 0, 32767, 0, 32767, 0, 0, 0, 16384, 0, 0, 0}, "VEC4", kShort);
  gltf.json["accessors"][position]["type"] = "VEC3";
  gltf.json["accessors"][position]["normalized"] = true;
  gltf.json["accessors"][position]["min"] = {-32768, 0, 0};
  gltf.json["accessors"][position]["max"] = {32767, 0, 32767};
  gltf.json["bufferViews"][0]["byteStride"] = 8;
  const std::size_t uv = gltf.accessor(std::vector<std::uint16_t>{0, 65535, 13107, 0, 0, 0}, "VEC2", kUnsignedShort);
  gltf.json["accessors"][uv]["normalized"] = true;
  gltf.primitive({{"POSITION", position}, {"TEXCOORD_0", uv}});
  // Three elements of eight bytes: x, y, z and padding.
  const Primitive primitive = only_primitive(gltf);
  ASSERT_EQ(primitive.position.size(), 3u);
  EXPECT_EQ(primitive.position[0], vec3(-1, 0, 1));
  EXPECT_FLOAT_EQ(primitive.position[2].x, 16384.0f / 32767.0f);
  EXPECT_EQ(primitive.uv[0], vec2(0, 1));
  EXPECT_FLOAT_EQ(primitive.uv[1].x, 0.2f);
}

TEST(Gltf, PaintedFactorsComeWithTheVertices) {
  Gltf gltf;
  gltf.primitive({{"POSITION", gltf.positions(kSquare)},
                  {"_STIFFNESS", gltf.accessor(std::vector<float>{1, 2, 3, 4}, "SCALAR", kFloat)},
                  {"_FRICTION", gltf.accessor(std::vector<float>{0.5f, 0, 1, 2}, "SCALAR", kFloat)},
                  {"_DAMPING", gltf.accessor(std::vector<float>{3, 0, 1, 2}, "SCALAR", kFloat)},
                  {"_RELAXATION", gltf.accessor(std::vector<float>{0, 5, 1, 2}, "SCALAR", kFloat)}})["mode"] = 5;
  EXPECT_EQ(only_primitive(gltf).stiffness, (std::vector<float>{1, 2, 3, 4}));
  EXPECT_EQ(only_primitive(gltf).friction, (std::vector<float>{0.5f, 0, 1, 2}));
  EXPECT_EQ(only_primitive(gltf).damping, (std::vector<float>{3, 0, 1, 2}));
  EXPECT_EQ(only_primitive(gltf).relaxation, (std::vector<float>{0, 5, 1, 2}));
  Gltf negative;
  negative.primitive({{"POSITION", negative.positions(kSquare)},
                      {"_STIFFNESS", negative.accessor(std::vector<float>{1, -2, 3, 4}, "SCALAR", kFloat)}});
  EXPECT_NE(negative.refusal().find("_STIFFNESS"), std::string::npos) << negative.refusal();
}

TEST(Gltf, ASkinAtRestShowsVerticesWhereJointsAndBindMatricesPutThem) {
  // Joint 0 rests at x = 1 and was bound at x = 1: its vertices stay. Joint 1, rotated by 90 degrees about z at (1, 0,
  // 0), was bound there unrotated: its vertices rotate about that point. The mesh's own node must not matter.
  Gltf gltf;
  std::vector<float> bind(32, 0.0f);
  for (std::size_t m = 0; m < 2; ++m) {
    for (std::size_t i = 0; i < 4; ++i) bind[16 * m + 5 * i] = 1.0f;
    bind[16 * m + 12] = -1.0f;
  }
  const std::size_t weights = gltf.accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4", kFloat);
  const std::size_t joints =
      gltf.accessor(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}, "VEC4", kUnsignedByte);
  const std::size_t position = gltf.positions({0, 0, 0, 2, 0, 0, 1, 3, 0});
  gltf.primitive({{"POSITION", position}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
  gltf.json["nodes"][0]["skin"] = 0;
  gltf.json["nodes"][0]["translation"] = {10, 20, 30};
  gltf.json["nodes"].push_back({{"translation", {1, 0, 0}}, {"children", {2}}});
  gltf.json["nodes"].push_back({{"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}});
  gltf.json["skins"] =
      Json::array({{{"joints", {1, 2}}, {"inverseBindMatrices", gltf.accessor(bind, "MAT4", kFloat)}}});
  const Result<Level> level = gltf.load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  const LevelNode& node = level->nodes[0];
  const std::vector<vec3> expected = {{0, 0, 0}, {1, 1, 0}, {-2, 0, 0}};
  for (std::size_t v = 0; v < 3; ++v) {
    const vec3 world =
        level->meshes[static_cast<std::size_t>(node.mesh)].primitives[0].position[v] + node.local.translation;
    EXPECT_LT(length(world - expected[v]), 1e-5f) << v;
  }
  EXPECT_FALSE(level->notes.empty());
}

TEST(Gltf, ASkinMovesThePrimitiveItBelongsToWhateverStandsBefore) {
  // The first primitive has no triangle, the second is skipped, the third is moved by 10 along x.
  Gltf gltf;
  std::vector<float> bind(16, 0.0f);
  for (std::size_t i = 0; i < 4; ++i) bind[5 * i] = 1.0f;
  bind[12] = 10.0f;
  const std::size_t position = gltf.positions(kSquare);
  const std::size_t weights =
      gltf.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", kFloat);
  const std::size_t joints = gltf.accessor(std::vector<std::uint8_t>(16, 0), "VEC4", kUnsignedByte);
  const std::size_t corners = gltf.accessor(std::vector<std::uint16_t>{0, 1, 2, 2, 1, 3}, "SCALAR", kUnsignedShort);
  const std::vector<float> one(12, 0.25f);
  gltf.primitive({{"POSITION", gltf.positions({0, 0, 0, 1, 0, 0, 0, 1, 0})},
                  {"JOINTS_0", gltf.accessor(std::vector<std::uint8_t>(12, 0), "VEC4", kUnsignedByte)},
                  {"WEIGHTS_0", gltf.accessor(one, "VEC4", kFloat)}})["indices"] =
      gltf.accessor(std::vector<std::uint16_t>{0, 1}, "SCALAR", kUnsignedShort);
  Json& primitives = gltf.json["meshes"][0]["primitives"];
  const Json attributes = {{"POSITION", position}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}};
  primitives.push_back({{"attributes", attributes}, {"mode", 0}});
  primitives.push_back({{"attributes", attributes}, {"indices", corners}});
  gltf.json["nodes"][0]["skin"] = 0;
  gltf.json["nodes"].push_back(Json::object());
  gltf.json["skins"] = Json::array({{{"joints", {1}}, {"inverseBindMatrices", gltf.accessor(bind, "MAT4", kFloat)}}});
  const Result<Level> level = gltf.load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  const LevelMesh& mesh = level->meshes[static_cast<std::size_t>(level->nodes[0].mesh)];
  ASSERT_EQ(mesh.primitives.size(), 1u);
  for (std::size_t v = 0; v < 4; ++v)
    EXPECT_LT(length(mesh.primitives[0].position[v] - vec3(kSquare[3 * v] + 10, kSquare[3 * v + 1], 0)), 1e-5f) << v;
}

TEST(Gltf, ParentsStandBeforeChildrenAndOtherScenesAreMarked) {
  Gltf gltf;
  gltf.json["nodes"] = Json::array(
      {{{"name", "leaf"}}, {{"name", "root"}, {"children", {3, 0}}}, {{"name", "elsewhere"}}, {{"name", "first"}}});
  gltf.json["scenes"] = Json::array({{{"nodes", {2}}}, {{"nodes", {1}}}});
  gltf.json["scene"] = 1;
  const Result<Level> level = gltf.load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < level->nodes.size(); ++i) {
    names.push_back(level->nodes[i].name);
    EXPECT_LT(level->nodes[i].parent, static_cast<std::int32_t>(i));
  }
  EXPECT_EQ(names, (std::vector<std::string>{"root", "first", "leaf", "elsewhere"}));
  EXPECT_FALSE(level->nodes[3].in_scene);
  EXPECT_TRUE(level->nodes[2].in_scene);
}

TEST(Gltf, PointsAreLeftOutWithANoteAndTheRestIsRead) {
  Gltf gltf;
  const std::size_t position = gltf.positions(kSquare);
  gltf.primitive({{"POSITION", position}})["mode"] = 0;
  gltf.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", position}}}});
  const Result<Level> level = gltf.load();
  ASSERT_TRUE(level.ok());
  EXPECT_EQ(level->meshes[0].primitives.size(), 1u);
  EXPECT_TRUE(std::any_of(level->notes.begin(), level->notes.end(),
                          [](const std::string& note) { return note.find("points") != std::string::npos; }));
}

TEST(Gltf, RefusalsNameThePlace) {
  const auto refused = [](const char* what, const std::string& place, const auto& damage) {
    Gltf gltf;
    const std::size_t position = gltf.positions(kSquare);
    const std::size_t index = gltf.accessor(std::vector<std::uint16_t>{0, 1, 2, 1, 3, 2}, "SCALAR", kUnsignedShort);
    gltf.primitive({{"POSITION", position}})["indices"] = index;
    ASSERT_EQ(gltf.refusal(), "");
    damage(gltf);
    EXPECT_NE(gltf.refusal().find(place), std::string::npos) << what << ": " << gltf.refusal();
  };
  refused("an index beyond the vertices", "/meshes/0/primitives/0/indices", [](Gltf& g) { g.bin[48] = 4; });
  refused("a position that is no number", "/accessors/0", [](Gltf& g) { g.bin[3] = g.bin[2] = 0xff; });
  refused("an accessor past its view", "/accessors/0", [](Gltf& g) { g.json["accessors"][0]["count"] = 5; });
  refused("a count that overflows", "/accessors/0", [](Gltf& g) { g.json["accessors"][0]["count"] = 4000000000u; });
  refused("a view past its buffer", "/bufferViews/0", [](Gltf& g) { g.json["bufferViews"][0]["byteLength"] = 1000; });
  refused("an offset that overflows", "/bufferViews/0",
          [](Gltf& g) { g.json["bufferViews"][0]["byteOffset"] = 4294967290u; });
  refused("a missing mesh", "/nodes/0/mesh", [](Gltf& g) { g.json["nodes"][0]["mesh"] = 7; });
  refused("a negative mesh", "/nodes/0/mesh", [](Gltf& g) { g.json["nodes"][0]["mesh"] = -1; });
  refused("a loop of nodes", "/nodes/0", [](Gltf& g) {
    g.json["nodes"][0]["children"] = {1};
    g.json["nodes"].push_back({{"children", {0}}});
  });
  refused("a node of two parents", "/nodes/2/children/0", [](Gltf& g) {
    g.json["nodes"].push_back({{"children", {0}}});
    g.json["nodes"].push_back({{"children", {0}}});
  });
  refused("a shearing matrix", "/nodes/0/matrix",
          [](Gltf& g) { g.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; });
  refused("an unknown required extension", "MADE_up",
          [](Gltf& g) { g.json["extensionsUsed"] = g.json["extensionsRequired"] = {"MADE_up"}; });
  refused("bounds that do not hold", "/accessors/0/max", [](Gltf& g) { g.json["accessors"][0]["max"][0] = 2; });
}

TEST(Gltf, HugeClaimsOfASmallFileAreRefusedBeforeMemoryIsTaken) {
  // A thousand primitives with the same vertices decode to far more than the file's size.
  Gltf gltf;
  const std::size_t position = gltf.positions(std::vector<float>(3 * 30000, 0.0f));
  gltf.primitive({{"POSITION", position}});
  for (int i = 0; i < 1000; ++i)
    gltf.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", position}}}});
  EXPECT_NE(gltf.refusal().find("split the level"), std::string::npos) << gltf.refusal();
  // Depth of the JSON text.
  const std::string deep = std::string(100000, '[');
  EXPECT_FALSE(load_gltf({reinterpret_cast<const std::uint8_t*>(deep.data()), deep.size()}, false, {}).ok());
}

}  // namespace
}  // namespace pliant::test
