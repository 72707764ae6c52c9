// Levels from glTF, edited at random and saved. Reading gives the edited Level, and other tools' data on unedited parts
// is preserved.
#include <cmath>
#include <random>

#include "content/author/edit_nodes.h"
#include "content/gltf/form/gltf_model.h"
#include "content/gltf/write/gltf_save.h"
#include "tests/content/gltf_builder.h"
#include "tests/content/merge_fixture.h"

namespace pliant::test {
namespace {

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
