// Limits on the cost of reading a small document. Shared accessors, primitives, weights, skins and Draco data are added
// up before they are read (content/gltf/check/gltf_cost.cpp), and shared data is decoded once.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "content/files/isolation.h"
#include "content/gltf/check/gltf_check.h"
#include "content/gltf/read/gltf_draco_reader.h"
#include "tests/content/gltf_builder.h"
#include "tests/content/lowered.h"

namespace pliant::test {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kVertexCount = 8000;
// 8 MiB of decoded data beyond the multiple of the buffers.
const double kEightMiB = 8.0 * limits::kMiB / limits::kDecoded.most;

// The first error of open_gltf, which reads every accessor: its place, then the sentence.
std::string found(const Gltf& gltf) {
  Findings findings;
  const Bytes bytes = gltf.glb();
  if (open_gltf(bytes, true, {}, findings)) return "";
  for (const Finding& each : findings)
    if (each.severity == Severity::kError) return each.pointer + ": " + each.message();
  return "nothing";
}

// An accessor of zeros except for its first element: it has almost no bytes.
std::size_t zeros(Gltf& gltf, const char* type) {
  const std::size_t width = static_cast<std::size_t>(type[3] - '0');
  const std::size_t indices = gltf.view(std::vector<std::uint32_t>{0});
  const std::size_t values = gltf.view(std::vector<float>(width, 0.0f));
  gltf.json["accessors"].push_back({{"type", type},
                                    {"componentType", kFloat},
                                    {"count", kVertexCount},
                                    {"sparse",
                                     {{"count", 1},
                                      {"indices", {{"bufferView", indices}, {"componentType", kUnsignedInt}}},
                                      {"values", {{"bufferView", values}}}}}});
  return gltf.json["accessors"].size() - 1;
}
std::size_t zero_positions(Gltf& gltf) {
  const std::size_t i = zeros(gltf, "VEC3");
  gltf.json["accessors"][i]["min"] = gltf.json["accessors"][i]["max"] = {0, 0, 0};
  return i;
}
std::size_t zero_joints(Gltf& gltf) {
  gltf.json["accessors"].push_back({{"type", "VEC4"}, {"componentType", kUnsignedByte}, {"count", kVertexCount}});
  return gltf.json["accessors"].size() - 1;
}

TEST(Cost, ZeroNormalsThatPrimitivesShareAreMendedOnlyWithinTheLimit) {
  const auto sharing = [](int primitives) {
    Gltf gltf;
    const Json attributes = {{"POSITION", zero_positions(gltf)}, {"NORMAL", zeros(gltf, "VEC3")}};
    gltf.primitive(attributes);
    for (int i = 1; i < primitives; ++i) gltf.json["meshes"][0]["primitives"].push_back({{"attributes", attributes}});
    return found(gltf);
  };
  const Lowered lowered(kEightMiB);
  EXPECT_EQ(sharing(10), "");
  EXPECT_THAT(sharing(14), HasSubstr("/meshes/0/primitives/13: makes the level decode to"));
  EXPECT_THAT(sharing(14), HasSubstr("split the level, or allow it with --limits"));
}

TEST(Cost, EverySetOfWeightsCounts) {
  const auto sets = [](int count, bool twice) {
    Gltf gltf;
    Json attributes = {{"POSITION", zero_positions(gltf)}};
    const std::size_t joints = zero_joints(gltf);
    std::size_t weights = 0;
    for (int k = 0; k < count; ++k) {
      if (k == 0 || !twice) weights = zeros(gltf, "VEC4");
      attributes["WEIGHTS_" + std::to_string(k)] = weights;
      attributes["JOINTS_" + std::to_string(k)] = joints;
    }
    gltf.primitive(attributes);
    for (int i = 1; i < 4; ++i) gltf.json["meshes"][0]["primitives"].push_back({{"attributes", attributes}});
    return found(gltf);
  };
  const Lowered lowered(kEightMiB);
  EXPECT_EQ(sets(4, false), "");
  EXPECT_THAT(sets(10, false), HasSubstr("makes the level decode to"));
  EXPECT_THAT(sets(2, true), HasSubstr("/attributes/WEIGHTS_1: is the accessor of another set of weights"));
}

TEST(Cost, AMeshIsReadAnewForEveryNodeWithASkin) {
  const auto shown = [](int nodes) {
    Gltf gltf;
    gltf.primitive(
        {{"POSITION", zero_positions(gltf)}, {"WEIGHTS_0", zeros(gltf, "VEC4")}, {"JOINTS_0", zero_joints(gltf)}});
    gltf.json["skins"] = Json::array({{{"joints", {0}}}});
    for (int i = 0; i < nodes; ++i) gltf.json["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
    return found(gltf);
  };
  const Lowered lowered(kEightMiB);
  EXPECT_EQ(shown(5), "");
  EXPECT_THAT(shown(12), HasSubstr("/nodes/9: makes the level decode to"));
}

TEST(Cost, APlaceholderOfAnySizeAllowsNothing) {
  Gltf gltf;
  for (int i = 0; i < 100; ++i) zeros(gltf, "VEC4");
  const auto found_beside = [&](Json placeholder) {
    Json json = gltf.json;
    json["buffers"] = Json::array({{{"byteLength", gltf.bin.size()}}});
    json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + std::string(gltf.bin.size() / 3 * 4, 'A') +
                                (gltf.bin.size() % 3 == 0   ? ""
                                 : gltf.bin.size() % 3 == 1 ? "AA=="
                                                            : "AAA=");
    if (!placeholder.is_null()) json["buffers"].push_back(placeholder);
    const std::string text = json.dump();
    Findings findings;
    const bool opened =
        open_gltf({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, false, {}, findings).has_value();
    return opened ? std::string() : findings.back().pointer + ": " + findings.back().message();
  };
  const Lowered lowered(kEightMiB);
  const std::string alone = found_beside(nullptr);
  EXPECT_THAT(alone, HasSubstr("brings the document to"));
  EXPECT_EQ(found_beside({{"byteLength", 2'000'000'000}}), alone);
}

// A strip of triangles along x, and the glTF that holds it compressed, in `primitives` primitives.
Gltf compressed(int primitives) {
  DracoMesh mesh;
  DracoAttribute position{"POSITION", 0, 3, false, {}};
  for (std::uint32_t i = 0; i < kVertexCount; ++i) {
    position.values.insert(position.values.end(), {static_cast<float>(i), static_cast<float>(i % 2), 0.0f});
    if (i + 2 < kVertexCount) mesh.index.insert(mesh.index.end(), {i, i + 1, i + 2});
  }
  mesh.vertices = kVertexCount;
  mesh.attributes.push_back(position);
  const Result<Bytes> blob = encode_draco(mesh, 14);
  EXPECT_TRUE(blob.ok());
  Gltf gltf;
  gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const std::size_t view = gltf.view(*blob);
  gltf.json["accessors"].push_back({{"type", "VEC3"},
                                    {"componentType", kFloat},
                                    {"count", mesh.vertices},
                                    {"min", {0, 0, 0}},
                                    {"max", {static_cast<float>(kVertexCount), 1, 0}}});
  gltf.json["accessors"].push_back({{"type", "SCALAR"}, {"componentType", kUnsignedInt}, {"count", mesh.index.size()}});
  Json& first = gltf.primitive({{"POSITION", 0}});
  first["indices"] = 1;
  first["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", view},
                                                       {"attributes", {{"POSITION", mesh.attributes[0].id}}}};
  const Json copy = first;
  for (int i = 1; i < primitives; ++i) gltf.json["meshes"][0]["primitives"].push_back(copy);
  return gltf;
}

TEST(Cost, DracoDataThatPrimitivesShareCountForEachOfThem) {
  const Lowered lowered(kEightMiB);
  EXPECT_EQ(found(compressed(10)), "");
  EXPECT_THAT(found(compressed(60)), HasSubstr("makes the level decode to"));
}

TEST(Cost, DracoDataThatPrimitivesShareAreDecodedOnce) {
  const Gltf gltf = compressed(2);
  Findings findings;
  const Bytes bytes = gltf.glb();
  std::optional<SourceDocument> document = open_gltf(bytes, true, {}, findings);
  ASSERT_TRUE(document);
  const Json& primitives = document->json["meshes"][0]["primitives"];
  DracoReader reader(*document);
  const Result<DracoMesh> first = reader.read(primitives[0], "");
  ASSERT_TRUE(first.ok()) << first.error().message();
  std::fill(document->buffers[0].begin(), document->buffers[0].end(), std::uint8_t{0});
  const Result<DracoMesh> second = reader.read(primitives[1], "");
  ASSERT_TRUE(second.ok()) << "read again: " << second.error().message();
  EXPECT_EQ(second->index, first->index);
  EXPECT_EQ(second->attributes[0].values, first->attributes[0].values);
  EXPECT_EQ(second->attributes[0].name, "POSITION");
}

TEST(Cost, SmallDracoDataAreDecodedTogetherAndADamagedOneIsNamedInItsPlace) {
  Gltf gltf = compressed(3);
  Json& primitives = gltf.json["meshes"][0]["primitives"];
  for (std::size_t i = 1; i < 3; ++i) {  // the same bytes again, in bufferViews of their own
    const Json view = gltf.json["bufferViews"][0];
    const auto begin = gltf.bin.begin() + view["byteOffset"].get<std::ptrdiff_t>();
    const Bytes copy(begin, begin + view["byteLength"].get<std::ptrdiff_t>());
    primitives[i]["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = gltf.view(copy);
  }
  const Result<Level> whole = gltf.load();
  ASSERT_TRUE(whole.ok()) << whole.error().message();
  ASSERT_EQ(whole->meshes[0].primitives.size(), 3u);
  for (const Primitive& each : whole->meshes[0].primitives)
    EXPECT_EQ(each.position, whole->meshes[0].primitives[0].position);
  gltf.bin[gltf.json["bufferViews"][2]["byteOffset"].get<std::size_t>()] = 'X';
  EXPECT_THAT(gltf.refusal(), HasSubstr("/meshes/0/primitives/2/extensions/KHR_draco_mesh_compression"));
}

TEST(Cost, DracoDataOfMoreCornersThanDeclaredAreRefused) {
  Gltf gltf = compressed(1);
  EXPECT_EQ(gltf.refusal(), "");
  gltf.json["accessors"][1]["count"] = 3;
  EXPECT_EQ(gltf.refusal(), "") << "three corners a vertex: no more than a closed surface has";
  EXPECT_EQ(most_draco_corners(3, 100), 600u);
  EXPECT_EQ(most_draco_corners(3000, 100), 3000u);
}

TEST(Cost, AChildHasTheSecondsThatAreLeftAndSaysHowManyItTook) {
  DracoMesh mesh;
  DracoAttribute position{"POSITION", 0, 3, false, {}};
  constexpr std::uint32_t kSide = 300;
  for (std::uint32_t j = 0; j < kSide; ++j)
    for (std::uint32_t i = 0; i < kSide; ++i) {
      position.values.insert(position.values.end(), {static_cast<float>(i), static_cast<float>(j), 0.0f});
      const std::uint32_t a = j * kSide + i;
      if (i + 1 < kSide && j + 1 < kSide) mesh.index.insert(mesh.index.end(), {a, a + 1, a + kSide});
    }
  mesh.vertices = kSide * kSide;
  mesh.attributes.push_back(position);
  const Result<Bytes> blob = encode_draco(mesh, 14);
  ASSERT_TRUE(blob.ok());
  double used = 0.0;
  EXPECT_TRUE(decode_draco(*blob, {0}, limits::kReaderTime.most, &used).ok());
  EXPECT_GT(used, 0.0);
  const Result<DracoMesh> late = decode_draco(*blob, {0}, 1e-6 - reading_time(blob->size()));
  ASSERT_FALSE(late.ok());
  EXPECT_THAT(late.error().message(), HasSubstr("takes too long to read"));
}

}  // namespace
}  // namespace pliant::test
