// Other formats in, glTF out and in again.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "content/level_file.h"
#include "tests/content/document_compare.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

class Convert : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path write(const char* name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  const fs::path folder_ = fs::temp_directory_path() / ("pliant-convert-" + std::to_string(::getpid()));
};

TEST_F(Convert, TheSameTetrahedronFromEveryFormatIsTheSameSurface) {
  const std::vector<std::pair<const char*, std::string>> files = {
      {"t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"},
      {"t.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"},
      {"t.ply",
       "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
       "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 "
       "3 2\n"},
      {"t.stl",
       "solid t\nfacet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
       "facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
       "facet normal 1 1 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
       "facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\nendsolid t\n"}};
  for (const auto& [name, text] : files) {
    const Result<Level> level = load_level(write(name, text));
    ASSERT_TRUE(level.ok()) << level.error().message();
    // The enclosed volume, from the divergence theorem, is 1/6 with outward triangles.
    float volume = 0.0f;
    for (const LevelMesh& mesh : level->meshes)
      for (const Primitive& p : mesh.primitives)
        for (std::size_t t = 0; t < p.index.size(); t += 3)
          volume += dot(p.position[p.index[t]], cross(p.position[p.index[t + 1]], p.position[p.index[t + 2]])) / 6.0f;
    EXPECT_NEAR(volume, 1.0f / 6.0f, 1e-6f) << name;
    ASSERT_TRUE(save_level(*level, folder_ / "t.glb").ok());
    const Result<Level> back = load_level(folder_ / "t.glb");
    ASSERT_TRUE(back.ok()) << back.error().message();
    EXPECT_EQ(Difference::of(*level, *back), "") << name;
  }
}

TEST_F(Convert, WhatCannotBeTouchedIsRefusedInASentence) {
  const std::string points =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 "
      "0\n1 1 1\n";
  const std::string nan = "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::string huge = "OFF\n2000000000 2000000000 0\n0 0 0\n";
  for (const auto& [name, text] :
       {std::pair{"points.ply", points}, std::pair{"nan.obj", nan}, std::pair{"huge.off", huge},
        std::pair{"empty.obj", std::string()}, std::pair{"what.xyz", std::string("?")}}) {
    const fs::path path = write(name, text);
    const Result<Level> level = load_level(path);
    ASSERT_FALSE(level.ok()) << name;
    EXPECT_EQ(level.error().message().rfind(path.string(), 0), 0u) << level.error().message();
  }
  EXPECT_FALSE(load_level(folder_ / "absent.obj").ok());
  EXPECT_FALSE(load_level(folder_).ok());
}

TEST_F(Convert, CorpusMeshesOfOtherFormatsReadBackAsTheyWereConverted) {
  const fs::path spot = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid/spot/spot_quadrangulated.obj";
  if (!fs::exists(spot)) GTEST_SKIP() << "the corpus is not beside the project";
  const Result<Level> level = load_level(spot);
  ASSERT_TRUE(level.ok());
  for (const char* name : {"spot.glb", "spot.gltf"}) {
    ASSERT_TRUE(save_level(*level, folder_ / name).ok());
    const Result<Level> back = load_level(folder_ / name);
    ASSERT_TRUE(back.ok()) << back.error().message();
    EXPECT_EQ(Difference::of(*level, *back), "");
  }
}

}  // namespace
}  // namespace pliant::test
