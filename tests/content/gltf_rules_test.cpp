// Rules of glTF 2.0 that the corpus does not cover. For each, a sound file loads, and a broken one is rejected with the
// place of the fault.
#include <gtest/gtest.h>

#include <functional>

#include "content/level_file.h"
#include "tests/content/gltf_builder.h"

namespace pliant::test {
namespace {

Gltf shown_square() {
  Gltf gltf;
  Json& primitive = gltf.primitive({{"POSITION", gltf.positions(kSquare)}});
  primitive["indices"] = gltf.accessor(std::vector<std::uint16_t>{0, 1, 2, 1, 3, 2}, "SCALAR", kUnsignedShort);
  gltf.json["scenes"] = Json::array({{{"nodes", {0}}}});
  gltf.json["scene"] = 0;
  return gltf;
}

// A square on two joints, nodes 1 and 2, below node 0, which shows it.
Gltf skinned(std::vector<std::uint8_t> joints = {0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0},
             std::vector<float> weights = {.5f, .5f, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0, 1, 0, 0, 0}) {
  Gltf gltf = shown_square();
  Json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = gltf.accessor(joints, "VEC4", kUnsignedByte);
  attributes["WEIGHTS_0"] = gltf.accessor(weights, "VEC4", kFloat);
  gltf.json["nodes"].push_back({{"name", "root"}, {"children", {2}}});
  gltf.json["nodes"].push_back({{"name", "tip"}});
  gltf.json["nodes"][0]["skin"] = 0;
  gltf.json["skins"] = Json::array({{{"joints", {1, 2}}}});
  gltf.json["scenes"][0]["nodes"] = {0, 1};
  return gltf;
}

// Node 0 moves along X in a second.
Gltf moving(const char* interpolation = "LINEAR") {
  Gltf gltf = shown_square();
  const std::size_t times = gltf.accessor(std::vector<float>{0, 1}, "SCALAR", kFloat, true);
  const std::size_t values =
      gltf.accessor(std::vector<float>(std::string(interpolation) == "CUBICSPLINE" ? 18 : 6, 0.5f), "VEC3", kFloat);
  gltf.json["animations"] = Json::array(
      {{{"samplers", Json::array({{{"input", times}, {"output", values}, {"interpolation", interpolation}}})},
        {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}})}}});
  return gltf;
}

struct Rule {
  const char* what;
  std::function<Gltf()> file;
  std::function<void(Json&)> change;
  const char* refused;  // "": it loads
};

Json& at(Json& json, const char* pointer) {
  return json[Json::json_pointer(pointer)];
}

TEST(GltfRules, SoundFilesLoadAndBrokenOnesAreRefusedWithTheirPlace) {
  const std::vector<Rule> rules = {
      {"an animated node", [] { return moving(); }, [](Json&) {}, ""},
      {"an animated node may have a matrix where another property moves", [] { return moving(); },
       [](Json& j) {
         at(j, "/nodes/0/matrix") = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
         j.erase("animations");
       },
       ""},
      {"a node with a matrix is not animated", [] { return moving(); },
       [](Json& j) { at(j, "/nodes/0/matrix") = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
       "/animations/0/channels/0/target/node"},
      {"splines", [] { return moving("CUBICSPLINE"); }, [](Json&) {}, ""},
      {"values are of splines or plain", [] { return moving("CUBICSPLINE"); },
       [](Json& j) {
         Json plain = at(j, "/animations/0/samplers/0");
         plain["interpolation"] = "STEP";
         at(j, "/animations/0/samplers").push_back(plain);
       },
       "/animations/0/samplers/1/output"},
      {"times are no values", [] { return moving(); },
       [](Json& j) { at(j, "/animations/0/samplers/0/output") = at(j, "/animations/0/samplers/0/input"); },
       "/animations/0/samplers/0/output"},
      {"a skin", [] { return skinned(); }, [](Json&) {}, ""},
      {"a skeleton above the joints", [] { return skinned(); }, [](Json& j) { at(j, "/skins/0/skeleton") = 1; }, ""},
      {"a skeleton below a joint", [] { return skinned(); }, [](Json& j) { at(j, "/skins/0/skeleton") = 2; },
       "/skins/0/skeleton"},
      {"joints that no scene shows", [] { return skinned(); }, [](Json& j) { at(j, "/scenes/0/nodes") = {0}; },
       "/nodes/0/skin"},
      {"a skinned mesh that no scene shows", [] { return skinned(); }, [](Json& j) { at(j, "/scenes/0/nodes") = {1}; },
       ""},
      {"a joint that stands twice, once without weight",
       [] {
         return skinned({1, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0},
                        {1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0, 1, 0, 0, 0});
       },
       [](Json&) {}, ""},
      {"a second skin with fewer joints than the mesh names", [] { return skinned(); },
       [](Json& j) {
         at(j, "/skins").push_back({{"joints", {1}}});
         at(j, "/nodes").push_back({{"mesh", 0}, {"skin", 1}});
       },
       "/accessors/"},
      {"an index of refraction of none", [] { return shown_square(); },
       [](Json& j) {
         j["materials"] = Json::array({{{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}});
         j["extensionsUsed"] = {"KHR_materials_ior"};
       },
       ""},
      {"an index of refraction below that of nothing", [] { return shown_square(); },
       [](Json& j) {
         j["materials"] = Json::array({{{"extensions", {{"KHR_materials_ior", {{"ior", 0.5}}}}}}});
         j["extensionsUsed"] = {"KHR_materials_ior"};
       },
       "/materials/0/extensions/KHR_materials_ior/ior"},
      {"a texture for WebP that names a PNG", [] { return shown_square(); },
       [](Json& j) {
         j["images"] = Json::array({{{"uri", "a.png"}, {"mimeType", "image/png"}}});
         j["textures"] = Json::array({{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}});
         j["extensionsUsed"] = {"EXT_texture_webp"};
       },
       "/textures/0/extensions/EXT_texture_webp/source"},
  };
  for (const Rule& rule : rules) {
    Gltf gltf = rule.file();
    rule.change(gltf.json);
    const Result<Level> level = gltf.load();
    if (*rule.refused == '\0') {
      EXPECT_TRUE(level.ok()) << rule.what << ": " << level.error().message();
      continue;
    }
    ASSERT_FALSE(level.ok()) << rule.what;
    EXPECT_NE(level.error().message().find(rule.refused), std::string::npos)
        << rule.what << ": " << level.error().message();
  }
}

TEST(GltfRules, TwoWeightsOfOneJointAreAddedUpWithANote) {
  const Result<Level> level = skinned({1, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}).load();
  ASSERT_TRUE(level.ok()) << level.error().message();
  ASSERT_FALSE(level->notes.empty());
  EXPECT_NE(level->notes[0].find("give joint 1 two weights in element 0; added up"), std::string::npos);
}

// As written by exporters at degenerate triangles: the residue of cancelling normals.
TEST(GltfRules, NormalsAndTangentsThatAreNearlyZeroAreMendedAsZeroOnesAre) {
  for (const float tiny : {0.0f, 1e-45f, 1e-41f, 1e-30f, 1e-10f, 5e-5f}) {
    Gltf gltf = shown_square();
    Json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["NORMAL"] = gltf.accessor(std::vector<float>{0, 0, 1, tiny, 0, 0, 0, 0, 1, 0, -tiny, 0}, "VEC3", kFloat);
    attributes["TANGENT"] =
        gltf.accessor(std::vector<float>{1, 0, 0, 1, tiny, 0, 0, 1, 1, 0, 0, -1, 0, tiny, 0, 1}, "VEC4", kFloat);
    const Result<Level> level = gltf.load();
    ASSERT_TRUE(level.ok()) << tiny << ": " << level.error().message();
    const Primitive& mended = level->meshes[0].primitives[0];
    for (const vec3& n : mended.normal) EXPECT_LT(length(n - vec3(0, 0, 1)), 1e-6f) << tiny;
    for (const vec4& t : mended.tangent) EXPECT_NEAR(length(vec3(t)), 1.0f, 1e-6f) << tiny;
    ASSERT_FALSE(level->notes.empty()) << tiny;
    EXPECT_NE(level->notes[0].find("holds 2 vectors of length 0"), std::string::npos) << level->notes[0];
  }
  for (const float wrong :
       {1e-2f, 0.5f, 2.0f, 1e20f, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    Gltf gltf = shown_square();
    gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        gltf.accessor(std::vector<float>{0, 0, 1, wrong, 0, 0, 0, 0, 1, 0, 0, 1}, "VEC3", kFloat);
    EXPECT_NE(gltf.refusal().find("/accessors/2"), std::string::npos) << wrong << ": " << gltf.refusal();
  }
}

}  // namespace
}  // namespace pliant::test
