// Meshes from other sources: organs, a hand, a bunny, a cow, a person.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "content/level_file.h"
#include "content/mesh/mesh_build.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
const fs::path kMeshes = fs::path(PLIANT_CORPUS_DIR) / "meshes-valid";

// Invariants of any touch mesh, by brute force where that is cheap.
void expect_sound(const BuiltMesh& built) {
  const Mesh& mesh = built.mesh;
  double area = 0.0, painted_area = 0.0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;  // how often an edge is traversed in this direction
  for (const uvec3& t : mesh.triangles) {
    const dvec3 a(mesh.position(t.x)), b(mesh.position(t.y)), c(mesh.position(t.z));
    area += 0.5 * length(cross(b - a, c - a));
    for (int i = 0; i < 3; ++i) ++runs[{t[i], t[(i + 1) % 3]}];
  }
  for (const float a : mesh.area) painted_area += static_cast<double>(a);
  EXPECT_NEAR(painted_area, area, 1e-5 * area);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
    ASSERT_NEAR(static_cast<double>(length(mesh.normal(v))), 1.0, 1e-5);

  std::uint32_t wrong = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3], other = mesh.across[t][i];
      const auto back = runs.find({b, a});
      const bool manifold = runs.at({a, b}) == 1 && back != runs.end() && back->second == 1;
      if (manifold != (other != kBorder)) ++wrong;
      if (other == kBorder) continue;
      const uvec3 o = mesh.triangles[other];
      if (!((o.x == b && o.y == a) || (o.y == b && o.z == a) || (o.z == b && o.x == a))) ++wrong;
    }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(mesh.tree.levels.back().size(), 1u);

  std::size_t drawn = 0;
  for (const DrawPart& part : built.draw.parts) drawn += part.index_count;
  EXPECT_EQ(drawn, built.draw.indices.size());
  EXPECT_GE(drawn, 3 * mesh.triangles.size());
  for (const DrawVertex& v : built.draw.vertices) {
    ASSERT_LT(v.touch_vertex, mesh.vertex_count);
    ASSERT_EQ(v.position, mesh.position(v.touch_vertex));
    ASSERT_NEAR(static_cast<double>(length(v.normal)), 1.0, 1e-4);
    ASSERT_NEAR(static_cast<double>(length(vec3(v.tangent))), 1.0, 1e-4);
    ASSERT_EQ(std::abs(v.tangent.w), 1.0f);
  }
}

TEST(MeshCorpus, EveryMeshOfEveryRealFileBuildsAndIsSound) {
  if (!fs::exists(kMeshes)) GTEST_SKIP() << "the corpus is not beside this checkout: " << kMeshes;
  std::size_t built_count = 0;
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(kMeshes)) {
    if (file.path().extension() != ".glb" && file.path().extension() != ".obj") continue;
    const Result<Level> level = load_level(file.path());
    ASSERT_TRUE(level.ok()) << level.error().message();
    for (const LevelMesh& mesh : level->meshes) {
      SCOPED_TRACE(file.path().filename().string() + ": " + mesh.name);
      const Result<BuiltMesh> built = build_mesh(mesh.name, mesh.primitives, mat4(1.0f));
      ASSERT_TRUE(built.ok()) << built.error().message();
      expect_sound(*built);
      ++built_count;
    }
  }
  EXPECT_GT(built_count, 20u);
}

TEST(MeshCorpus, TheCowIsClosedOnceItsTextureSeamsAreWelded) {
  const fs::path file = kMeshes / "spot/spot_triangulated.obj";
  if (!fs::exists(file)) GTEST_SKIP() << "the corpus is not beside this checkout: " << kMeshes;
  const Result<Level> level = load_level(file);
  ASSERT_TRUE(level.ok()) << level.error().message();
  const Result<BuiltMesh> built = build_mesh("spot", level->meshes.at(0).primitives, mat4(1.0f));
  ASSERT_TRUE(built.ok());
  EXPECT_TRUE(built->mesh.closed);
  EXPECT_EQ(built->mesh.vertex_count, 2930u);  // the file's own `v` lines, whatever the seams
  EXPECT_EQ(built->mesh.triangles.size(), 5856u);
  EXPECT_GT(built->draw.vertices.size(), built->mesh.vertex_count);
}

}  // namespace
}  // namespace pliant
