// The study `collision`: its path and its count of misses.
#include "lab/study/collision/study_collision.h"

#include <gtest/gtest.h>

#include "content/mesh/mesh_build.h"
#include "lab/study/collision/upward_tree.h"
#include "scenes/scenes.h"

namespace pliant {
namespace {

Mesh mesh_of(const Primitive& p) {
  auto built = build_mesh("test", std::span(&p, 1), mat4(1));
  return std::move(built->mesh);
}

TEST(StudyCollision, AProbeWandersNearTheSurfaceInStepsOfAHand) {
  const Mesh mesh = mesh_of(scenes::sphere(10, 0.1));
  const double L = mesh.box.diagonal();
  const std::vector<dvec3> way = wander(mesh, 2000);
  ASSERT_EQ(way.size(), 2000u);
  for (std::size_t i = 1; i < way.size(); ++i) {
    EXPECT_LT(length(way[i] - way[i - 1]), 1.5e-3 * L);
    EXPECT_NEAR(length(way[i]), 0.1 - 0.005 * L, 0.015 * L);
  }
}

TEST(StudyCollision, NothingIsMissedOnASphereWhateverTheSearch) {
  const Mesh mesh = mesh_of(scenes::sphere(12, 0.1));
  const std::vector<dvec3> way = wander(mesh, 2000);
  const Truth truth = truth_along(mesh, way, 200);
  for (const Search search : kSearches) {
    const SearchFigures figures = search_along(mesh, search, way, truth);
    if (search == Search::kUpwards) continue;  // see below
    EXPECT_EQ(figures.misses, 0.0) << name_of(search);
    if (search != Search::kPatches) EXPECT_EQ(figures.strict, 0.0) << name_of(search);
    EXPECT_EQ(figures.checked, 200u);
  }
}

// Two sheets face each other 10 mm apart, and the path goes from one to the other: a walk stays on the first.
TEST(StudyCollision, AWalkMissesTheOtherWallOfAGapAndATreeDoesNot) {
  Primitive p = scenes::sheet(20, 0.1);
  const auto count = static_cast<std::uint32_t>(p.position.size());
  for (std::uint32_t v = 0; v < count; ++v) p.position.push_back(p.position[v] * vec3(1, -1, 1) + vec3(0, 0.01f, 0));
  const std::vector<std::uint32_t> index = p.index;
  for (std::size_t i = 0; i < index.size(); i += 3)
    for (const std::size_t k : {0, 2, 1}) p.index.push_back(count + index[i + k]);
  const Mesh mesh = mesh_of(p);
  std::vector<dvec3> way;
  for (int i = 0; i < 1000; ++i) way.push_back({0.013, 0.001 + 0.008 * i / 999.0, 0.007});
  const Truth truth = truth_along(mesh, way, 1000);
  const auto misses = [&](Search search) { return search_along(mesh, search, way, truth).misses; };
  for (const Search search : {Search::kWalk, Search::kPatches}) {
    EXPECT_GT(misses(search), 0.3) << name_of(search);
    EXPECT_EQ(misses(search), misses(search)) << "the same in every run";
  }
  for (const Search search : {Search::kTree, Search::kClosest, Search::kClosestHint, Search::kUpwardsBall})
    EXPECT_EQ(misses(search), 0.0) << name_of(search);
}

// A cell that contains the query need not contain the vertex nearest to it.
TEST(StudyCollision, P1sTreeMissesNearerVerticesAsPrintedAndNoneWhenRepaired) {
  const Mesh mesh = mesh_of(scenes::sphere(12, 0.1));
  const UpwardTree tree(mesh);
  std::uint32_t printed = 0, repaired = 0;
  int wrong = 0;
  for (const dvec3& x : wander(mesh, 2000)) {
    double least2 = 1e30;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
      const dvec3 d = dvec3(mesh.position(v)) - x;
      least2 = std::min(least2, dot(d, d));
    }
    const UpwardTree::Answer one = tree.as_printed(x, printed), other = tree.repaired(x, repaired);
    printed = one.vertex, repaired = other.vertex;
    wrong += one.distance2 > least2;
    ASSERT_EQ(other.distance2, least2);
  }
  EXPECT_GT(wrong, 100);
  EXPECT_LT(wrong, 1000);
}

TEST(StudyCollision, ScatteredQueriesFindTheNearestPlace) {
  const SearchFigures figures = search_scattered(2'000, 500, 100);
  EXPECT_EQ(figures.checked, 100u);
  EXPECT_EQ(figures.strict, 0.0);
  EXPECT_GT(figures.us, 0.0);
  EXPECT_LT(figures.us, 1e6);
}

}  // namespace
}  // namespace pliant
