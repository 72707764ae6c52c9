// load(save(load(f))) equals load(f), bit for bit, for every kind of Level and every save option.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "components/monotone_cubic.h"
#include "content/files/file_io.h"
#include "content/level_file.h"
#include "tests/content/document_compare.h"
#include "tests/content/gltf_builder.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

// A folder that is removed after the test.
class Document : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("pliant-document-") + info->name() + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  Level load(const fs::path& path) {
    Result<Level> level = load_level(path);
    EXPECT_TRUE(level.ok()) << (level ? "" : level.error().message());
    return level ? *level : Level{};
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  fs::path folder_;
};

// A bumpy sheet of n x n vertices with every attribute.
Primitive sheet(std::uint32_t n) {
  Primitive out;
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(n - 1),
                  v = static_cast<float>(j) / static_cast<float>(n - 1);
      out.position.emplace_back(0.1f * u, 0.01f * std::sin(9.0f * u) * std::cos(7.0f * v), 0.1f * v);
      out.normal.push_back(normalize(vec3(std::sin(u), 2.0f, std::cos(3.0f * v))));
      out.tangent.push_back(vec4(normalize(vec3(1.0f, 0.1f * u, 0.0f)), i % 2 ? 1.0f : -1.0f));
      out.uv.emplace_back(u, v);
      out.stiffness.push_back(0.5f + u);
      out.friction.push_back(1.0f + v);
      out.damping.push_back(2.0f + v);
      out.relaxation.push_back(3.0f + v);
    }
  for (std::uint32_t j = 0; j + 1 < n; ++j)
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
      const std::uint32_t a = j * n + i;
      out.index.insert(out.index.end(), {a, a + n, a + 1, a + 1, a + n, a + n + 1});
    }
  out.material = 0;
  return out;
}

// A Level with something in every member.
Level everything() {
  Level level;
  Material material;
  material.name = "skin";
  material.base_color = {0.8f, 0.3f, 0.25f, 0.7f};
  material.metallic = 0.1f;
  material.roughness = 0.37f;
  material.emissive = {0.1f, 3.7f, 0.3f};
  material.normal_scale = 0.6f;
  material.occlusion_strength = 0.4f;
  material.base_color_texture = 0;
  material.normal_texture = 1;
  material.occlusion_texture = 0;
  material.ior = 1.41f;
  material.transmission = 0.2f;
  material.thickness = 0.013f;
  material.transmission_texture = 1;
  material.thickness_texture = 0;
  material.attenuation_color = {0.9f, 0.1f, 0.2f};
  material.attenuation_distance = 0.02f;
  material.specular = 0.7f;
  material.specular_color = {0.9f, 0.8f, 1.0f};
  material.clearcoat = 0.6f;
  material.clearcoat_roughness = 0.15f;
  material.diffuse_transmission = 0.4f;
  material.diffuse_transmission_color = {0.9f, 0.3f, 0.2f};
  material.alpha = Material::Alpha::kMask;
  material.alpha_cutoff = 0.33f;
  material.double_sided = true;
  level.materials.push_back(material);
  for (int k = 0; k < 2; ++k) {
    Image image{k ? "bumps" : "colour", 5, 3, {}};
    for (std::uint8_t i = 0; i < 60; ++i) image.rgba.push_back(static_cast<std::uint8_t>(i * (k ? 3 : 4)));
    level.images.push_back(image);
  }
  level.meshes.push_back({"sheet", {sheet(7), sheet(5)}});
  level.nodes.resize(5);
  LevelNode& body = level.nodes[0];
  body.name = "body.of/work";
  body.mesh = 0;
  body.local.translation = {0.1f, -0.2f, 1.0f / 3.0f};
  body.local.rotation = normalize(quat(0.3f, 0.5f, -0.2f, 0.7f));
  body.local.scale = {1.0f, 2.0f, -0.5f};
  body.children = {1, 2};
  body.deformable = Deformable{};
  body.deformable->spring = SpringLaw::kStandardLinearSolid;
  body.deformable->relaxation_time = 0.125;
  body.deformable->contact_damping_material = true;
  body.deformable->young = 5400.0;
  body.deformable->stiffness = 2.0 * 5400.0 / (1.0 - 0.45 * 0.45) * 0.004;
  body.scaled_with_young = body.deformable->stiffness / Deformable{}.stiffness;
  body.deformable->relaxation_stiffness *= body.scaled_with_young;
  body.deformable->cubic *= body.scaled_with_young;
  body.deformable->shape = Shape::kKelvinlet;
  body.deformable->distance = Distance::kSurface;
  body.deformable->friction_static = body.deformable->friction_sliding = 0.1;
  body.soft_body = SoftBody{};
  body.soft_body->pinned.add(vec3(-1, 0, 0.1f));
  body.soft_body->pinned.add(vec3(1, 0.5f, 0.2f));
  body.soft_body->rayleigh = {0.1, 0.02};
  LevelNode& probe = level.nodes[1];
  probe.name = "probe";
  probe.parent = 0;
  probe.probe = Probe{};
  probe.probe->radius = 0.0025;
  probe.probe->color = {0.1f, 0.2f, 0.3f};
  probe.probe_device = "hand";
  LevelNode& hand = level.nodes[2];
  hand.name = "hand";
  hand.parent = 0;
  hand.device = HapticDevice{};
  hand.device->driver = DriverKind::kScript;
  hand.device->file = "strokes/one.csv";
  hand.device->max_force = 7.9;
  hand.handle = Handle6{};
  hand.handle->attachment = Attachment::kSpring;
  hand.handle->max_torque = 0.25;
  hand.handle->force = ToolForce::kLinear;
  hand.handle->device = "hand";
  LevelNode& lamp = level.nodes[3];
  lamp.name = "lamp";
  lamp.light = Light{Light::Kind::kSpot, {1, 0.9f, 0.8f}, 12.5f, 4.0f, 0.2f, 0.6f};
  lamp.rigid_body = RigidBody{};
  lamp.rigid_body->fixed = true;
  LevelNode& eye = level.nodes[4];
  eye.name = "eye";
  eye.camera = Camera{0.6f, 0.002f, 5.0f};
  level.environment = LevelEnvironment{"../sky.exr", 1.5, 0.3};
  level.simulation.touch_rate = 2000.0;
  level.simulation.gravity = {0, 0, -1.62};
  return level;
}

TEST_F(Document, ALevelMadeInMemoryReadsBackAsItWasSaved) {
  const Level level = everything();
  for (const char* name : {"level.gltf", "level.glb"}) {
    const Status saved = save_level(level, folder_ / name);
    ASSERT_TRUE(saved.ok()) << saved.error().message();
    EXPECT_EQ(Difference::of(level, load(folder_ / name)), "") << name;
  }
}

TEST_F(Document, ATableOfForceAndTheForceOfASphereReadBackAsTheyWereSaved) {
  Level table = everything(), sphere = everything();
  Deformable& d = *table.nodes[0].deformable;
  d = Deformable{};
  table.nodes[0].scaled_with_young = 1.0;
  d.spring = SpringLaw::kQuasiLinearTable;
  d.table = {4, {{{0, 0}, {1e-3, 1.0 / 3.0}, {2.5e-3, 1.0 / 3.0}, {4e-3, 2.5}}}};
  d.stiffness = stiffness_of(d.table);
  d.relaxation_stiffness = 123.25;
  sphere.nodes[0].deformable->sphere = SphereForce::kSneddon;
  for (const Level& level : {table, sphere})
    for (const char* name : {"level.gltf", "level.glb"}) {
      const Status saved = save_level(level, folder_ / name);
      ASSERT_TRUE(saved.ok()) << saved.error().message();
      EXPECT_EQ(Difference::of(level, load(folder_ / name)), "") << name;
    }
}

TEST_F(Document, SavingWhatWasLoadedChangesNothingWhateverTheContainer) {
  ASSERT_TRUE(save_level(everything(), folder_ / "first.gltf").ok());
  const Level first = load(folder_ / "first.gltf");
  for (const char* name : {"again.gltf", "again.glb", "first.gltf"}) {
    ASSERT_TRUE(save_level(first, folder_ / name).ok());
    EXPECT_EQ(Difference::of(first, load(folder_ / name)), "") << name;
  }
}

TEST_F(Document, DracoKeepsEveryPositionWithinItsQuantisation) {
  Level level;
  level.meshes.push_back({"sheet", {sheet(40)}});
  level.meshes[0].primitives[0].material = -1;
  level.nodes.resize(1);
  level.nodes[0].name = "sheet";
  level.nodes[0].mesh = 0;
  Box box;
  for (const vec3 p : level.meshes[0].primitives[0].position) box.add(p);
  const float allowed = 2.4e-5f * std::max({box.size().x, box.size().y, box.size().z});
  ASSERT_TRUE(save_level(level, folder_ / "plain.glb").ok());
  ASSERT_TRUE(save_level(level, folder_ / "small.glb", {16}).ok());
  EXPECT_LT(fs::file_size(folder_ / "small.glb"), fs::file_size(folder_ / "plain.glb") / 3);
  const Level small = load(folder_ / "small.glb");
  ASSERT_EQ(small.meshes.size(), 1u);
  const Primitive &before = level.meshes[0].primitives[0], &after = small.meshes[0].primitives[0];
  ASSERT_EQ(after.position.size(), before.position.size());
  EXPECT_EQ(after.index.size(), before.index.size());
  EXPECT_EQ(after.stiffness.size(), before.position.size());
  // The encoder renumbers vertices: each must match an original vertex at its position, with its attributes.
  for (std::size_t v = 0; v < after.position.size(); ++v) {
    std::size_t nearest = 0;
    for (std::size_t w = 0; w < before.position.size(); ++w)
      if (length(before.position[w] - after.position[v]) < length(before.position[nearest] - after.position[v]))
        nearest = w;
    const vec3 error = glm::abs(before.position[nearest] - after.position[v]);
    ASSERT_LE(std::max({error.x, error.y, error.z}), allowed);
    ASSERT_NEAR(before.stiffness[nearest], after.stiffness[v], 1e-4);
    ASSERT_LT(length(before.uv[nearest] - after.uv[v]), 2e-4f);
    ASSERT_LT(length(before.normal[nearest] - after.normal[v]), 2e-3f);
  }
}

TEST_F(Document, WhatIsCompressedIsCompressedAnewOrWrittenPlainAsItDecodes) {
  Level level;
  level.meshes.push_back({"sheet", {sheet(40)}});
  level.meshes[0].primitives[0].material = -1;
  level.nodes.resize(1);
  level.nodes[0].name = "sheet";
  level.nodes[0].mesh = 0;
  level.nodes[0].deformable = Deformable{};
  ASSERT_TRUE(save_level(level, folder_ / "fine.glb", {16}).ok());
  const Level fine = load(folder_ / "fine.glb");
  ASSERT_TRUE(save_level(fine, folder_ / "coarse.glb", {9}).ok());
  EXPECT_LT(fs::file_size(folder_ / "coarse.glb"), fs::file_size(folder_ / "fine.glb"));
  SaveOptions plain;
  plain.no_draco = true;
  ASSERT_TRUE(save_level(fine, folder_ / "plain.glb", plain).ok());
  const Level back = load(folder_ / "plain.glb");
  EXPECT_EQ(Difference::of(fine, back), "");
  EXPECT_TRUE(back.nodes[0].deformable);
  EXPECT_FALSE(back.source->json.contains("extensionsRequired"));
}

TEST_F(Document, ABinOfSomethingElseIsNotReplaced) {
  const auto text_of = [](const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  std::ofstream(folder_ / "a.bin") << "precious";
  EXPECT_FALSE(save_level(everything(), folder_ / "a.gltf").ok());
  EXPECT_EQ(text_of(folder_ / "a.bin"), "precious");
  EXPECT_FALSE(fs::exists(folder_ / "a.gltf"));
  std::ofstream(folder_ / "a.gltf")
      << R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "b.bin", "byteLength": 8}]})";
  EXPECT_FALSE(save_level(everything(), folder_ / "a.gltf").ok());
  EXPECT_EQ(text_of(folder_ / "a.bin"), "precious");
  ASSERT_TRUE(save_level(everything(), folder_ / "b.gltf").ok());
  EXPECT_TRUE(save_level(everything(), folder_ / "b.gltf").ok()) << "its own";
}

TEST_F(Document, WhatTheEditorChangesIsSavedAndTheRestOfTheDocumentStays) {
  Gltf gltf;
  gltf.primitive({{"POSITION", gltf.positions(kSquare)}});
  gltf.json["nodes"][0]["matrix"] = {0, 0, -2, 0, 0, 2, 0, 0, 2, 0, 0, 0, 1, 2, 3, 1};
  gltf.json["nodes"][0]["extras"] = {{"keep", "me"}};
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"roughnessFactor", 0.25}, {"metallicFactor", 0.5}}},
                             {"extras", {{"keep", "it"}}},
                             {"extensions", {{"KHR_materials_sheen", {{"sheenRoughnessFactor", 0.5}}}}}}};
  gltf.json["extensionsUsed"] = {"KHR_materials_sheen"};
  gltf.json["scenes"] = Json::array({{{"nodes", {0}}, {"name", "kept"}}});
  ASSERT_TRUE(write_file(folder_ / "in.glb", gltf.glb()).ok());
  Level level = load(folder_ / "in.glb");
  EXPECT_EQ(level.nodes[0].local.translation, vec3(1, 2, 3));
  EXPECT_EQ(level.nodes[0].local.scale, vec3(2));
  level.nodes[0].local.translation.x = 7.0f;
  level.materials[0].metallic = 1.0f;  // glTF's default: the member goes
  level.materials[0].clearcoat = 0.75f;
  make_touchable(level);
  ASSERT_TRUE(set_key(level, "thing.deformable.stiffness=123").ok());
  LevelNode added;
  added.name = "finger";
  added.probe = Probe{};
  level.nodes.push_back(added);
  ASSERT_TRUE(save_level(level, folder_ / "out.gltf").ok());
  const Level back = load(folder_ / "out.gltf");
  EXPECT_EQ(Difference::of(level, back), "");
  EXPECT_EQ(back.source->json["nodes"][0]["extras"]["keep"], "me");
  EXPECT_EQ(back.source->json["scenes"][0]["name"], "kept");
  const Json& material = back.source->json["materials"][0];
  EXPECT_EQ(material["extras"]["keep"], "it");
  EXPECT_EQ(material["extensions"]["KHR_materials_sheen"]["sheenRoughnessFactor"], 0.5);
  EXPECT_EQ(material["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"], 0.75);
  EXPECT_EQ(material["pbrMetallicRoughness"]["roughnessFactor"], 0.25);
  EXPECT_FALSE(material["pbrMetallicRoughness"].contains("metallicFactor"));
  EXPECT_FALSE(back.source->json["nodes"][0].contains("matrix"));
}

TEST_F(Document, AFailedSaveLeavesNothingBehindAndWhatWasThereStays) {
  ASSERT_TRUE(save_level(everything(), folder_ / "level.glb").ok());
  const std::size_t before = files();
  Level broken = everything();
  broken.meshes[0].primitives[0].position[3].y = NAN;
  EXPECT_FALSE(save_level(broken, folder_ / "level.glb").ok());
  EXPECT_FALSE(save_level(everything(), folder_ / "absent" / "level.glb").ok());
  EXPECT_FALSE(save_level(everything(), folder_ / "level.obj").ok());
  EXPECT_FALSE(save_level(everything(), folder_ / "other.glb", {40}).ok());
  EXPECT_EQ(files(), before);
  EXPECT_EQ(Difference::of(everything(), load(folder_ / "level.glb")), "");
}

TEST_F(Document, ExternalFilesAreFoundBesideTheLevelAndNeverElsewhere) {
  fs::create_directories(folder_ / "level");
  Gltf gltf;
  gltf.primitive({{"POSITION", gltf.positions(kSquare)}});
  const auto write = [&](const std::string& uri) {
    Json json = gltf.json;
    json["buffers"] = Json::array({{{"byteLength", gltf.bin.size()}, {"uri", uri}}});
    std::ofstream(folder_ / "level" / "level.gltf") << json;
    return load_level(folder_ / "level" / "level.gltf");
  };
  ASSERT_TRUE(write_file(folder_ / "level" / "my data.bin", gltf.bin).ok());
  ASSERT_TRUE(write_file(folder_ / "secret.bin", gltf.bin).ok());
  EXPECT_TRUE(write("my%20data.bin").ok());
  EXPECT_FALSE(write("../secret.bin").ok());
  EXPECT_FALSE(write("%2e%2e/secret.bin").ok());
  EXPECT_FALSE(write((folder_ / "secret.bin").string()).ok());
  EXPECT_FALSE(write("file:///" + (folder_ / "secret.bin").string()).ok());
  EXPECT_FALSE(write("http://example.com/data.bin").ok());
  EXPECT_FALSE(write("absent.bin").ok());
  EXPECT_FALSE(write(".").ok());
  fs::create_symlink(folder_ / "secret.bin", folder_ / "level" / "link.bin");
  EXPECT_FALSE(write("link.bin").ok());
}

TEST_F(Document, SavingASkinnedLevelKeepsItsSkin) {
  const fs::path hand = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid/webxr-hand/right.glb";
  if (!fs::exists(hand)) GTEST_SKIP() << "the corpus is not beside the project";
  const Level first = load(hand);
  for (const char* name : {"hand.gltf", "hand.glb"}) {
    ASSERT_TRUE(save_level(first, folder_ / name).ok());
    const Level again = load(folder_ / name);
    EXPECT_EQ(Difference::of(first, again), "") << name;
    EXPECT_TRUE(again.source->json.contains("skins"));
  }
  ASSERT_TRUE(save_level(first, folder_ / "small.glb", {14}).ok());
  EXPECT_EQ(load(folder_ / "small.glb").meshes.back().primitives[0].index.size(),
            first.meshes.back().primitives[0].index.size());
}

}  // namespace
}  // namespace pliant::test
