// The height texture in a material's extras: preserved by saving; other extras are not trusted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "content/keys/extensions.h"
#include "content/keys/unused_keys.h"
#include "content/level/unfelt_relief.h"
#include "content/level_file.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

// A triangle whose material has these extras, and one texture.
Result<Level> triangle_with(const std::string& extras) {
  const fs::path folder = fs::path(testing::TempDir()) / "pliant_relief";
  fs::create_directories(folder);
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::ofstream(folder / "t.bin", std::ios::binary).write(reinterpret_cast<const char*>(corners), sizeof corners);
  std::ofstream(folder / "t.gltf") << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [{"extras": )" << extras
                                   << R"(}],
    "textures": [{"source": 0}],
    "images": [{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="}],
    "buffers": [{"uri": "t.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]})";
  Result<Level> level = load_level(folder / "t.gltf");
  fs::remove_all(folder);
  return level;
}

TEST(Relief, IsReadFromAMaterialsExtrasAndComesBackFromASavedLevel) {
  Result<Level> level = triangle_with(R"({"height_texture": {"index": 0}, "height_scale": 0.0005})");
  ASSERT_TRUE(level.ok()) << level.error().message();
  ASSERT_EQ(level->materials.size(), 1u);
  EXPECT_EQ(level->materials[0].height_texture, 0);
  EXPECT_EQ(level->materials[0].height_scale, 0.0005f);

  // Saved as read, and as a level that was never a file.
  Level made;
  made.name = "made";
  made.images = level->images;
  made.materials = level->materials;
  made.meshes = level->meshes;
  made.nodes = level->nodes;
  const fs::path path = fs::path(testing::TempDir()) / "pliant_relief.glb";
  const Level* both[] = {&*level, &made};
  for (const Level* saved : both) {
    const Status done = save_level(*saved, path, SaveOptions{});
    ASSERT_TRUE(done.ok()) << done.error().message();
    const Result<Level> again = load_level(path);
    ASSERT_TRUE(again.ok()) << again.error().message();
    ASSERT_EQ(again->materials.size(), 1u);
    ASSERT_GE(again->materials[0].height_texture, 0);
    EXPECT_EQ(again->images.at(static_cast<std::size_t>(again->materials[0].height_texture)).rgba,
              level->images.at(0).rgba);
    EXPECT_EQ(again->materials[0].height_scale, 0.0005f);
  }
  fs::remove(path);
}

TEST(Relief, ExtrasOfAnotherFormAreLeftAlone) {
  for (const char* extras :
       {"7", "[]", "{}", R"({"height_texture": 3})", R"({"height_texture": {"index": 9}, "height_scale": 1})",
        R"({"height_texture": {"index": -1}, "height_scale": 1})", R"({"height_texture": {"index": 0}})",
        R"({"height_texture": {"index": 0}, "height_scale": "tall"})",
        R"({"height_texture": {"index": 0}, "height_scale": -1})",
        R"({"height_texture": {"index": 0.5}, "height_scale": 1})"}) {
    Result<Level> level = triangle_with(extras);
    ASSERT_TRUE(level.ok()) << extras << ": " << level.error().message();
    EXPECT_EQ(level->materials.at(0).height_texture, -1) << extras;
  }
}

// The relief of `effects` is that of its studs alone, whether a world copies or takes the images.
TEST(Relief, IsMadeForTheSurfacesThatAreToFeelIt) {
  for (const bool moves : {false, true}) {
    Result<Level> level = load_level(PLIANT_SOURCE_DIR "/content/levels/effects.glb");
    ASSERT_TRUE(level.ok()) << level.error().message();
    EXPECT_FALSE(unfelt_relief(*level));
    std::vector<std::string> notes;
    const Result<World> world = moves ? spawn_moving_images(*level, &notes) : spawn(*level, &notes);
    ASSERT_TRUE(world.ok()) << world.error().message();
    EXPECT_THAT(notes, testing::IsEmpty());
    int felt = 0;
    for (auto [entity, deformable] : world->registry.view<const Deformable>()) {
      EXPECT_EQ(world->meshes[deformable.mesh].relief != nullptr, deformable.relief > 0.0);
      felt += deformable.relief > 0.0;
    }
    EXPECT_EQ(felt, 1);
  }
}

TEST(Relief, ThatIsDrawnAndNotFeltIsSaidOnceUnlessItIsMeant) {
  Result<Level> level = load_level(PLIANT_SOURCE_DIR "/content/levels/effects.glb");
  ASSERT_TRUE(level.ok()) << level.error().message();
  const auto studs = std::find_if(level->nodes.begin(), level->nodes.end(),
                                  [](const LevelNode& node) { return node.name == "studs"; });
  ASSERT_NE(studs, level->nodes.end());
  studs->deformable->relief = 0.0;
  studs->stated.erase("deformable.relief");
  const std::optional<Note> note = unfelt_relief(*level);
  ASSERT_TRUE(note);
  EXPECT_EQ(note->code, "relief.unfelt");
  EXPECT_EQ(note->what, "`studs`: the relief that its material draws is not felt");
  EXPECT_EQ(set_key(*level, "studs.deformable.relief=0").ok(), true);
  EXPECT_FALSE(unfelt_relief(*level));
  EXPECT_TRUE(set_key(*level, "glass.deformable.relief=1").ok());
  const std::vector<Note> unused = unused_key_notes(*level);
  ASSERT_EQ(unused.size(), 1u);
  EXPECT_EQ(unused[0].what,
            "`glass`: PLIANT_deformable/relief is of normal and height maps, and no material of the mesh has one with "
            "texture coordinates");
}

}  // namespace
}  // namespace pliant
