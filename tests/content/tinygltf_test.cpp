// Content that tinygltf 2.7 cannot read, or would lose in writing, is read and preserved (gltf_rewrite.cpp,
// gltf_model.h). The oracle is an equivalent document that tinygltf can read.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "content/files/isolation.h"
#include "content/gltf/form/gltf_model.h"
#include "content/level_file.h"
#include "tests/content/document_compare.h"
#include "tests/content/gltf_builder.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

std::string base64(const Bytes& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

// A square of four corners and six indices, on one buffer of 60 bytes.
Gltf square() {
  Gltf gltf;
  Json& primitive = gltf.primitive({{"POSITION", gltf.positions(kSquare)}});
  primitive["indices"] = gltf.accessor(std::vector<std::uint16_t>{0, 1, 2, 1, 3, 2}, "SCALAR", kUnsignedShort);
  return gltf;
}

// Two channels without a node between two with one.
Gltf moving() {
  Gltf gltf = square();
  const std::size_t times = gltf.accessor(std::vector<float>{0, 1}, "SCALAR", kFloat, true),
                    values = gltf.accessor(std::vector<float>{0, 0, 0, 1, 2, 3}, "VEC3", kFloat);
  const auto channel = [](Json target) { return Json{{"sampler", 0}, {"target", std::move(target)}}; };
  gltf.json["animations"] = Json::array(
      {{{"samplers", Json::array({{{"input", times}, {"output", values}}})},
        {"channels",
         Json::array({channel({{"path", "translation"}}), channel({{"node", 0}, {"path", "translation"}}),
                      channel({{"path", "pointer"},
                               {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/0/scale"}}}}}}),
                      channel({{"node", 0}, {"path", "scale"}})})}}});
  gltf.json["extensionsUsed"] = {"KHR_animation_pointer"};
  return gltf;
}

// The document as a .gltf file of this text.
Result<Level> load_text(const Json& json) {
  const std::string text = json.dump();
  return load_gltf({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, false, {});
}

void expect_square(const Result<Level>& level, const std::string& what) {
  ASSERT_TRUE(level.ok()) << what << ": " << level.error().message();
  EXPECT_EQ(Difference::of(*square().load(), *level), "") << what;
}

// The replacement JSON for tinygltf, if any.
std::optional<Json> rewritten(const Bytes& glb) {
  Findings findings;
  Container container;
  SourceDocument document;
  EXPECT_TRUE(split_glb(glb, container, findings) && parse_json(container.json, document.json, findings));
  FetchedBytes fetched = fetch_bytes(document, container, findings);
  EXPECT_FALSE(any_error(findings));
  return rewritten_for_tinygltf(document, container, fetched);
}

TEST(Tinygltf, ReadsAGlbThatStandsAloneFromItsOwnBytes) {
  EXPECT_FALSE(rewritten(square().glb()));
  EXPECT_TRUE(rewritten(moving().glb()));  // has channels without a node
}

TEST(Tinygltf, BuffersOfEveryFormThatGltfAllowsHoldTheSame) {
  const Gltf gltf = square();
  Bytes longer = gltf.bin;
  longer.resize(64, 7);
  const std::string plain = base64(gltf.bin), octets = "data:application/octet-stream";
  for (const std::string& uri :
       {octets + ";base64," + plain, octets + ";charset=utf-8;base64," + plain, octets + ";base64," + base64(longer),
        octets + ";base64," + base64(longer).substr(0, base64(longer).find('=')),
        "data:application/gltf-buffer;base64," + plain}) {
    Json json = gltf.json;
    json["buffers"] = Json::array({{{"byteLength", gltf.bin.size()}, {"uri", uri}}});
    expect_square(load_text(json), uri.substr(0, 60));
  }
  const fs::path folder = fs::temp_directory_path() / ("pliant-tinygltf-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  ASSERT_TRUE(write_file(folder / "a+b c.bin", longer).ok());
  Json json = gltf.json;
  json["buffers"] = Json::array({{{"byteLength", gltf.bin.size()}, {"uri", "a+b%20c.bin"}}});
  std::ofstream(folder / "level.gltf") << json;
  expect_square(load_level(folder / "level.gltf"), "a longer file with + in its name");
  fs::remove_all(folder);
}

TEST(Tinygltf, BuffersWithoutDataDoNotTakeTheBinChunkOfAnother) {
  const Gltf gltf = square();
  Json json = gltf.json;
  json["buffers"] = Json::array({{{"byteLength", gltf.bin.size()}}, {{"byteLength", 1000}}});
  json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 48}});
  json["accessors"].push_back({{"bufferView", 2}, {"componentType", kFloat}, {"count", 4}, {"type", "VEC3"}});
  json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 2;
  Result<Level> level = load_gltf(as_glb(json.dump(), gltf.bin), true, {});
  ASSERT_TRUE(level.ok()) << level.error().message();
  const Primitive& read = level->meshes.at(0).primitives.at(0);
  EXPECT_EQ(read.index.size(), 6u);
  for (const vec3& normal : read.normal) EXPECT_EQ(normal, vec3(0));
}

TEST(Tinygltf, IndicesWithoutABufferViewAreZerosAndWhatIsSparseOverThem) {
  Gltf gltf = square();
  const std::size_t places = gltf.view(std::vector<std::uint8_t>{0, 1, 2, 3, 4, 5});
  Json& indices = gltf.json["accessors"][1];
  const Json view = indices["bufferView"];
  indices.erase("bufferView");
  indices["sparse"] = {{"count", 6},
                       {"indices", {{"bufferView", places}, {"componentType", kUnsignedByte}}},
                       {"values", {{"bufferView", view}}}};
  expect_square(gltf.load(), "sparse indices");
}

TEST(Tinygltf, WhatItDoesNotKnowAndNothingUsesIsLeftAsItIs) {
  Gltf gltf = square();
  gltf.json["accessors"].push_back({{"componentType", kFloat}, {"count", 4}, {"type", "VEC9"}});
  gltf.json["accessors"].push_back({{"componentType", 6000}, {"count", 4}, {"type", "VEC3"}});
  gltf.json["cameras"] = Json::array({{{"type", "fisheye"}}});
  const Result<Level> level = gltf.load();
  expect_square(level, "unknown types");
  EXPECT_EQ(level->source->json["accessors"], gltf.json["accessors"]);
  EXPECT_EQ(level->source->json["cameras"], gltf.json["cameras"]);
}

TEST(Tinygltf, AnUnknownChunkInTheSecondPlaceIsPassedOver) {
  Bytes bytes = Gltf{}.glb();
  const std::uint32_t chunk[3] = {4, 0x12345678, 0};
  append_bytes(bytes, chunk, sizeof chunk);
  const std::uint32_t total = static_cast<std::uint32_t>(bytes.size());
  std::memcpy(&bytes[8], &total, 4);
  const Result<Level> level = load_gltf(bytes, true, {});
  ASSERT_TRUE(level.ok()) << level.error().message();
  EXPECT_EQ(level->notes.size(), 1u);
}

TEST(Tinygltf, ChannelsWithoutANodeMoveNothingAndLeaveTheOthersTheirNumbers) {
  const Result<Level> level = moving().load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  const LevelAnimation& animation = level->animations.at(0);
  ASSERT_EQ(animation.channels.size(), 2u);
  EXPECT_EQ(animation.channels[0].property, NodeProperty::kTranslation);
  EXPECT_EQ(animation.channels[1].property, NodeProperty::kScale);
  ASSERT_EQ(level->source->model.animations.at(0).channels.size(), 4u);
  EXPECT_EQ(level->source->model.animations[0].channels[0].target_node, -1);
}

TEST(Tinygltf, AnExtensionOfAnAnimationIsNotCopiedIntoItsSamplers) {
  Gltf gltf = moving();
  gltf.json["extensionsUsed"].push_back("X_large");
  gltf.json["animations"][0]["extensions"]["X_large"]["values"] = std::vector<int>(1000, 1);
  const Result<Level> level = gltf.load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  EXPECT_TRUE(level->source->model.animations.at(0).samplers.at(0).extensions.empty());
  EXPECT_TRUE(level->source->json["animations"][0]["extensions"].contains("X_large"));
}

TEST(Tinygltf, NamesOfAttributesDoNotEndAtANul) {
  Gltf gltf = square();
  const std::size_t factors = gltf.accessor(std::vector<float>{1, 2, 3, 4}, "SCALAR", kFloat);
  gltf.json["meshes"][0]["primitives"][0]["attributes"][std::string("_STIFFNESS\0x", 12)] = factors;
  expect_square(gltf.load(), "not _STIFFNESS");
}

TEST(Tinygltf, ExtrasOfAMegabyteTakeNoMemoryTwice) {
  Gltf gltf = square();
  gltf.json["extras"] = Json(std::vector<int>(600000, 1));
  gltf.json["materials"] = Json::array({{{"alphaMode", "BLEND"}, {"mine", {{"x", 1}}}}});
  const Result<Level> level = gltf.load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  EXPECT_EQ(level->source->model.extras.Type(), tinygltf::NULL_TYPE);
  EXPECT_EQ(level->source->model.materials.at(0).additionalValues.count("mine"), 0u);
  EXPECT_EQ(level->materials.at(0).alpha, Material::Alpha::kBlend);
  EXPECT_EQ(level->source->json["extras"].size(), 600000u);
}

TEST(Tinygltf, SavingKeepsWhatItsWriterWouldLoseToTheDigit) {
  Gltf gltf = moving();
  Json& json = gltf.json;
  json["extras"] = {nullptr, Json::object(), Json::array(), 12345678901234, 1e300, 2.0, 2};
  json["mine"] = {{"x", 1}};
  json["extensionsUsed"] = {"KHR_animation_pointer", "X_mine"};
  for (const char* key : {"accessors", "bufferViews", "nodes", "meshes"}) {
    json[key][0]["extras"] = {{"kept", {{"empty", Json::array()}, {"none", nullptr}, {"large", 9999999999}}}};
    json[key][0]["extensions"] = {{"X_mine", {{"a", Json::array({Json::object()})}}}};
  }
  json["nodes"][0]["translation"] = {0, 1, 2.5};
  json["nodes"][0]["mine"] = 1;
  json["samplers"] = Json::array({{{"wrapS", 33071}, {"extras", 1}, {"extensions", {{"X_mine", Json::object()}}}}});
  json["skins"] = Json::array({{{"joints", {0}}, {"extras", Json::array()}}});
  json["materials"] = Json::array({{{"alphaMode", "OPAQUE"}, {"alphaCutoff", 0.5}, {"extras", nullptr}}});
  const fs::path folder = fs::temp_directory_path() / ("pliant-tinygltf-" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const Result<Level> level = gltf.load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  for (const char* name : {"level.glb", "level.gltf"}) {
    ASSERT_TRUE(save_level(*level, folder / name).ok());
    const Result<Level> again = load_level(folder / name);
    ASSERT_TRUE(again.ok()) << again.error().message();
    Json back = again->source->json, expected = json;
    back.erase("buffers");
    EXPECT_EQ(back.dump(), expected.dump()) << name;
  }
  fs::remove_all(folder);
}

TEST(Tinygltf, ALevelMadeInMemoryKeepsWhatItsWriterWouldLose) {
  Level level;
  Material faint;
  faint.name = std::string("faint\0glow", 10);
  faint.emissive = {1e-13f, 0, 0};
  level.materials = {faint, Material{}};
  level.nodes.resize(2);  // one in no scene
  level.nodes[0].name = "n";
  level.nodes[0].in_scene = level.nodes[1].in_scene = false;
  const fs::path file = fs::temp_directory_path() / ("pliant-tinygltf-" + std::to_string(::getpid()) + ".glb");
  ASSERT_TRUE(save_level(level, file).ok());
  const Result<Level> back = load_level(file);
  fs::remove(file);
  ASSERT_TRUE(back.ok()) << back.error().message();
  ASSERT_EQ(back->materials.size(), 2u);
  EXPECT_EQ(back->materials[0].name, faint.name);
  EXPECT_EQ(back->materials[0].emissive, faint.emissive);
  ASSERT_EQ(back->nodes.size(), 2u);
  EXPECT_FALSE(back->nodes[0].in_scene);
}

}  // namespace
}  // namespace pliant::test
