// The height texture in a material's extras: preserved by saving; other extras are not trusted.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

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

}  // namespace
}  // namespace pliant
