// Levels from glTF, edited and saved. Reading gives the edited Level, and other tools' data on unedited parts is
// preserved.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "content/author/edit_nodes.h"
#include "content/files/file_io.h"
#include "content/gltf/form/gltf_model.h"
#include "content/gltf/write/gltf_save.h"
#include "content/level_file.h"
#include "tests/content/document_compare.h"
#include "tests/content/gltf_builder.h"
#include "tests/content/level_normal.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

class MergeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("pliant-merge-") + info->name() + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  // Saves and reads again.
  Level again(const Level& level, const char* name = "again.glb") {
    const Status saved = save_level(level, folder_ / name);
    EXPECT_TRUE(saved.ok()) << (saved.ok() ? "" : saved.error().message());
    Result<Level> back = load_level(folder_ / name);
    EXPECT_TRUE(back.ok()) << (back ? "" : back.error().message());
    return back ? *back : Level{};
  }
  Bytes bytes(const char* name) { return *read_file(folder_ / name); }
  fs::path folder_;
};

std::string difference(const Level& a, const Level& b) {
  return Difference::of(normal_form(a), normal_form(b));
}

// Every file of ours and of the corpus that is not too large.
std::vector<fs::path> files() {
  std::vector<fs::path> out;
  for (const char* folder : {"content/levels", "../shared/corpus/meshes-valid", "../shared/corpus/meshes-draco"}) {
    const fs::path below = fs::path(PLIANT_SOURCE_DIR) / folder;
    if (!fs::exists(below)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(below)) {
      const std::string extension = entry.path().extension().string();
      if ((extension == ".glb" || extension == ".gltf") && entry.file_size() < 1000000 && load_level(entry.path()))
        out.push_back(entry.path());  // some files of the corpus lack their resources
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

const Json* node_tagged(const Json& json, std::int32_t tag) {
  for (const Json& node : array_of(json, "nodes"))
    if (node.contains("extras") && node["extras"].is_object() && value_of(node["extras"], "tag", -1) == tag)
      return &node;
  return nullptr;
}

// The file with another tool's marks on everything: extras and, with `foreign`, an extension that Pliant does not know.
Bytes marked(const fs::path& path, bool foreign) {
  Findings findings;
  std::optional<SourceDocument> document = open_gltf(path, findings);
  EXPECT_TRUE(document) << path;
  Json& json = document->json;
  for (const char* list : {"nodes", "meshes", "materials", "animations", "skins", "accessors", "textures"})
    if (json.contains(list))
      for (std::size_t i = 0; i < json[list].size(); ++i) {
        if (std::string(list) != "materials") json[list][i]["extras"] = {{"tag", i}};
        if (foreign) json[list][i]["extensions"]["X_foreign"] = {{"tag", i}};
      }
  json["extras"] = {{"tag", "root"}};
  if (foreign) declare_extension(json, "X_foreign", false);
  const Bytes bin = pack_document(*document, false);
  return as_glb(json.dump(), bin);
}

class Editing {
 public:
  Editing(Level& level, unsigned seed) : level_(level), random_(seed) {
    for (const LevelMesh& mesh : level.meshes) skinned_ = skinned_ || mesh.skinned >= 0;
  }
  void step() {
    if (level_.nodes.empty()) {  // the root of all was removed
      LevelNode root;
      root.name = "root";
      add_node(level_, root);
    }
    switch (below(9)) {
      case 0:
        return add();
      case 1:
        return remove();
      case 2:
        return reparent();
      case 3:
        return rename();
      case 4:
        return paint();
      case 5:
        return components();
      case 6:
        return copy();
      case 7:
        return light_and_camera();
      default:
        return move();
    }
  }

 private:
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  float any() { return static_cast<float>(below(2001)) / 1000.0f - 1.0f; }
  std::int32_t node() { return static_cast<std::int32_t>(below(level_.nodes.size())); }
  LevelNode& at(std::int32_t i) { return level_.nodes[static_cast<std::size_t>(i)]; }

  void add() {
    LevelNode made;
    made.name = below(2) ? "made" : "";
    made.local.translation = {any(), any(), any()};
    if (below(2) && !level_.meshes.empty()) made.mesh = static_cast<std::int32_t>(below(level_.meshes.size()));
    if (below(4) == 0) {  // a mesh that no document has
      Primitive triangle;
      triangle.position = {{0, 0, 0}, {1, 0, 0}, {0, any() + 2.0f, 0}};
      triangle.index = {0, 1, 2};
      if (below(2)) {
        Material material;
        material.name = "made";
        material.base_color = {0.5f, 0.25f, 0.125f, 1.0f};
        if (below(2)) {
          level_.images.push_back({"made", 1, 1, {1, 2, 3, 255}});
          material.base_color_texture = static_cast<std::int32_t>(below(level_.images.size()));
          triangle.uv = {{0, 0}, {1, 0}, {0, 1}};
        }
        triangle.material = static_cast<std::int32_t>(level_.materials.size());
        level_.materials.push_back(material);
      }
      made.mesh = static_cast<std::int32_t>(level_.meshes.size());
      level_.meshes.push_back({"made", {triangle}});
    }
    add_node(level_, made, below(2) ? node() : kNoLevelNode);
  }
  void remove() {
    if (level_.nodes.size() > 3) remove_node(level_, node());
  }
  void reparent() {
    if (!skinned_) (void)move_node(level_, node(), below(3) ? node() : kNoLevelNode, below(4));
  }
  void rename() { EXPECT_TRUE(rename_node(level_, node(), "name " + std::to_string(below(1000))).ok()); }
  void paint() {
    if (level_.meshes.empty()) return;
    LevelMesh& mesh = level_.meshes[below(level_.meshes.size())];
    if (mesh.primitives.empty()) return;
    Primitive& primitive = mesh.primitives[below(mesh.primitives.size())];
    std::vector<float>& values = primitive.*kPainted[below(kPainted.size())].values;
    if (values.empty() || below(3)) {
      values.assign(primitive.position.size(), 1.0f);
      for (float& value : values) value = 1.0f + std::abs(any());
    } else {
      values.clear();
    }
  }
  void components() {
    LevelNode& it = at(node());
    if (it.mesh >= 0 && !it.deformable) {
      it.deformable = Deformable{};
      it.deformable->stiffness = 100.0 + static_cast<double>(below(100));
    } else {
      it.deformable.reset();
      if (below(2)) it.probe = Probe{};
    }
    level_.simulation.gravity.y = -static_cast<double>(below(10));
    level_.about = below(2) ? "Edited." : "";
  }
  void copy() {
    if (level_.nodes.size() < 60) copy_node(level_, node());
  }
  void light_and_camera() {
    LevelNode& it = at(node());
    if (it.light && below(3) == 0)
      it.light.reset();
    else
      it.light = Light{static_cast<Light::Kind>(below(3)), {0.5f, 1.0f, 0.25f}, 1.0f + any() * 0.5f, 0.0f, 0.1f, 0.5f};
    LevelNode& other = at(node());
    if (other.camera && below(3) == 0)
      other.camera.reset();
    else
      other.camera = Camera{0.5f, 0.01f, 3.0f + any()};
  }
  void move() {
    if (!skinned_) at(node()).local.translation = {any(), any(), any()};
  }

  Level& level_;
  std::mt19937 random_;
  bool skinned_ = false;
};

// Only spots keep their cones.
void forget_cones(Level& level) {
  for (LevelNode& node : level.nodes)
    if (node.light && node.light->kind != Light::Kind::kSpot)
      node.light->inner_cone = Light{}.inner_cone, node.light->outer_cone = Light{}.outer_cone;
}

TEST_F(MergeTest, WhateverIsEditedIsReadAgainAndWhatOtherToolsWroteOfTheRestIsStillThere) {
  const std::vector<fs::path> all = files();
  ASSERT_GE(all.size(), 5u);
  for (std::size_t f = 0; f < all.size(); ++f)
    for (unsigned seed = 0; seed < 6; ++seed) {
      const bool foreign = seed % 2 == 1;
      SCOPED_TRACE(all[f].string() + " seed " + std::to_string(seed));
      ASSERT_TRUE(write_file(folder_ / "in.glb", marked(all[f], foreign)).ok());
      Result<Level> level = load_level(folder_ / "in.glb");
      ASSERT_TRUE(level.ok()) << level.error().message();
      Editing editing(*level, seed + 100 * static_cast<unsigned>(f));
      for (int k = 0; k < 4 + 8 * static_cast<int>(seed); ++k) editing.step();
      forget_cones(*level);
      const Level back = again(*level);
      ASSERT_EQ(difference(*level, back), "");
      // Marks on the remaining elements.
      const Json& json = back.source->json;
      EXPECT_EQ(json["extras"]["tag"], "root");
      for (const LevelNode& node : level->nodes) {
        if (node.source < 0) continue;
        const Json* kept = node_tagged(json, node.source);
        ASSERT_TRUE(kept) << node.source;
        if (foreign) EXPECT_EQ((*kept)["extensions"]["X_foreign"]["tag"], node.source);
      }
      EXPECT_EQ(array_of(json, "materials").size(), level->materials.size());
      // Saving again gives the same bytes.
      const Bytes first = bytes("again.glb");
      ASSERT_TRUE(save_level(back, folder_ / "third.glb").ok());
      ASSERT_EQ(bytes("third.glb"), first);
      if (::testing::Test::HasFailure()) return;
    }
}

TEST_F(MergeTest, WhatIsNotEditedIsTheSameJson) {
  for (const fs::path& path : files()) {
    SCOPED_TRACE(path.string());
    Result<Level> level = load_level(path);
    ASSERT_TRUE(level.ok());
    const Level back = again(*level);
    Json before = level->source->json, after = back.source->json;
    for (const char* place : {"buffers", "bufferViews", "images"}) before.erase(place), after.erase(place);
    // A stiffness written as text of another length is written as a number.
    EXPECT_EQ(Json::diff(before, after), Json::array());
    const Bytes first = bytes("again.glb");
    ASSERT_TRUE(save_level(back, folder_ / "third.glb").ok());
    EXPECT_EQ(bytes("third.glb"), first);
  }
}

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

TEST_F(MergeTest, WhatAKhronosValidatorSaysOfEditedFilesIsNoError) {
  const std::string script =
      "const v=require('gltf-validator');const fs=require('fs');"
      "v.validateBytes(new Uint8Array(fs.readFileSync(process.argv[1]))).then(r=>{"
      "const e=r.issues.messages.filter(m=>m.severity==0);e.slice(0,5).forEach(m=>console.log(JSON.stringify(m)));"
      "process.exit(e.length?1:0)}).catch(e=>{console.log(e);process.exit(2)})";
  if (std::system("node -e \"require('gltf-validator')\" >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "npm's gltf-validator is not installed (npm install -g gltf-validator; NODE_PATH=$(npm root -g))";
  for (const fs::path& path : files()) {
    SCOPED_TRACE(path.string());
    Result<Level> level = load_level(path);
    ASSERT_TRUE(level.ok());
    const bool skinned = std::any_of(level->meshes.begin(), level->meshes.end(),
                                     [](const LevelMesh& mesh) { return mesh.skinned >= 0; });
    Editing editing(*level, 7);
    for (int k = 0; k < 25; ++k) editing.step();
    ASSERT_TRUE(save_level(*level, folder_ / "edited.glb").ok());
    if (skinned) continue;  // these have expected errors
    EXPECT_EQ(std::system(("node -e \"" + script + "\" " + (folder_ / "edited.glb").string()).c_str()), 0);
  }
}

}  // namespace
}  // namespace pliant::test
