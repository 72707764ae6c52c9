#include <gtest/gtest.h>

#include <set>

#include "content/mesh/mesh_build.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

Mesh mesh_of(const Primitive& p) {
  Result<BuiltMesh> built = build_mesh("test", {&p, 1}, mat4(1.0f));
  EXPECT_TRUE(built.ok());
  return std::move(built->mesh);
}

bool holds(const Box& outer, const Box& inner) {
  return outer.min == glm::min(outer.min, inner.min) && outer.max == glm::max(outer.max, inner.max);
}

TEST(Zones, CoverEveryVertexOnceAndPadWithWhatHasNoArea) {
  const Mesh mesh = mesh_of(test::icosphere(4));
  EXPECT_EQ(mesh.zone_count(), (mesh.vertex_count + kZoneSize - 1) / kZoneSize);
  std::uint32_t next = 0;
  for (std::uint32_t z = 0; z < mesh.zone_count(); ++z) {
    EXPECT_EQ(mesh.zone_begin(z), next);
    next = mesh.zone_end(z);
    EXPECT_GT(next, mesh.zone_begin(z));
  }
  EXPECT_EQ(next, mesh.vertex_count);
  EXPECT_EQ(mesh.px.size(), mesh.zone_count() * std::size_t{kZoneSize});
  for (std::size_t v = mesh.vertex_count; v < mesh.px.size(); ++v) EXPECT_EQ(mesh.area[v], 0.0f);
  for (const uvec3& t : mesh.triangles) EXPECT_LT(std::max({t.x, t.y, t.z}), mesh.vertex_count);
}

TEST(Zones, BoxesHoldTheirVerticesAndEveryTriangleAroundThem) {
  const Mesh mesh = mesh_of(test::icosphere(4));
  for (const uvec3& t : mesh.triangles) {
    Box box;
    for (int i = 0; i < 3; ++i) box.add(mesh.position(t[i]));
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(holds(mesh.zone_box[t[i] / kZoneSize], box));
  }
}

TEST(Zones, NeighboursAreThoseThatShareATriangleByBruteForce) {
  for (const Primitive& p : {test::icosphere(4), test::sheet(40)}) {
    const Mesh mesh = mesh_of(p);
    std::vector<std::set<std::uint32_t>> expected(mesh.zone_count());
    for (const uvec3& t : mesh.triangles)
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          if (t[i] / kZoneSize != t[k] / kZoneSize) expected[t[i] / kZoneSize].insert(t[k] / kZoneSize);
    ASSERT_EQ(mesh.zone_neighbour_first.size(), mesh.zone_count() + 1);
    for (std::uint32_t z = 0; z < mesh.zone_count(); ++z) {
      const auto begin = mesh.zone_neighbours.begin() + mesh.zone_neighbour_first[z];
      const auto end = mesh.zone_neighbours.begin() + mesh.zone_neighbour_first[z + 1];
      EXPECT_EQ(std::vector<std::uint32_t>(begin, end),
                std::vector<std::uint32_t>(expected[z].begin(), expected[z].end()));
    }
  }
}

TEST(Zones, AreCompactPatches) {
  const Mesh mesh = mesh_of(test::icosphere(6));
  double sum = 0.0;
  for (const Box& box : mesh.zone_box) sum += static_cast<double>(box.diagonal());
  // 128 vertices at spacing e fill a disc of diameter about 12 e; a run of grid rows would be hundreds of e long.
  EXPECT_LT(sum / mesh.zone_count(), 30.0 * static_cast<double>(mesh.mean_edge));
}

TEST(Tree, BoxesHoldAllBelowThemUpToOneRoot) {
  for (const Primitive& p : {test::icosphere(0), test::icosphere(4), test::sheet(1)}) {
    const Mesh mesh = mesh_of(p);
    const auto& levels = mesh.tree.levels;
    ASSERT_EQ(levels[0].size(), (mesh.triangles.size() + kLeafSize - 1) / kLeafSize);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Box box;
      for (int i = 0; i < 3; ++i) box.add(mesh.position(mesh.triangles[t][i]));
      EXPECT_TRUE(holds(levels[0][t / kLeafSize], box));
    }
    for (std::size_t n = 1; n < levels.size(); ++n) {
      ASSERT_EQ(levels[n].size(), (levels[n - 1].size() + kTreeWidth - 1) / kTreeWidth);
      for (std::size_t i = 0; i < levels[n - 1].size(); ++i)
        EXPECT_TRUE(holds(levels[n][i / kTreeWidth], levels[n - 1][i]));
    }
    ASSERT_EQ(levels.back().size(), 1u);
    EXPECT_EQ(levels.back()[0].min, mesh.box.min);
    EXPECT_EQ(levels.back()[0].max, mesh.box.max);
  }
}

}  // namespace
}  // namespace pliant
