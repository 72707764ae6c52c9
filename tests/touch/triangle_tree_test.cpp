// The tree of a mesh at rest against every triangle looked at one by one.
#include "systems/touch/collide/triangle_tree.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <set>

#include "components/curved_patch.h"
#include "scenes/scenes.h"
#include "systems/touch/collide/surface_query.h"

namespace pliant {
namespace {

using scenes::Stage;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(engine_); }
  dvec3 in_cube() { return {unit(), unit(), unit()}; }
  std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(engine_() % n); }

 private:
  std::mt19937 engine_;
};

// A sheet squeezed along x: triangles ten thousand times as long as wide.
Primitive slivers() {
  Primitive p = scenes::sheet(30, 0.2);
  for (vec3& x : p.position) x = {1e-4f * x.x, 0.01f * std::sin(40 * x.z), x.z};
  return p;
}

std::vector<Primitive> shapes() {
  return {scenes::sheet(12, 0.2), scenes::sphere(12, 0.1), scenes::slab(10, 0.2, 0.004), scenes::valley(10, 0.2, 0.6),
          slivers()};
}

TEST(TriangleTree, HoldsEveryTriangleOnceWithItsCurvedPatchInEveryBoxAboveIt) {
  Stage stage;
  for (const Primitive& shape : shapes()) {
    const Mesh& mesh = stage.mesh(stage.add(shape, {}));
    const auto& nodes = mesh.tree.nodes;
    const float round = static_cast<float>(rounding(mesh, dvec3(0)));
    std::vector<int> seen(mesh.triangles.size(), 0);
    double bulge = 0;
    const std::function<Box(std::uint32_t)> check = [&](std::uint32_t at) {
      Box whole;
      for (std::uint32_t i = 0; i < nodes[at].used; ++i) {
        Box inside;
        for (std::uint32_t t = nodes[at].first[i]; nodes[at].count[i] && t < nodes[at].first[i] + nodes[at].count[i];
             ++t) {
          ++seen[t];
          const CurvedPatch patch = curved_patch(mesh, t);
          for (const dvec3& b : patch.b) inside.add(vec3(b));
          const dvec3 n = normalize(cross(patch.b[1] - patch.b[0], patch.b[2] - patch.b[0]));
          for (const dvec3& b : patch.b) bulge = std::max(bulge, std::abs(dot(b - patch.b[0], n)));
        }
        if (nodes[at].count[i] == 0) {
          EXPECT_GT(nodes[at].first[i], at);  // children behind parents
          inside = check(nodes[at].first[i]);
        }
        for (int k = 0; k < 3; ++k) {
          EXPECT_LE(nodes[at].low[k][i], inside.min[k] + round);
          EXPECT_GE(nodes[at].high[k][i], inside.max[k] - round);
        }
        whole.add(inside);
      }
      return whole;
    };
    check(0);
    for (const int n : seen) ASSERT_EQ(n, 1);
    EXPECT_GE(mesh.tree.bulge, 0.999999 * bulge - static_cast<double>(round));
    EXPECT_LE(mesh.tree.bulge, kMostPatchBulge * 3 * static_cast<double>(mesh.box.diagonal()));
  }
}

TEST(TriangleTree, FlatFacetsHaveNoBulge) {
  Stage stage;
  EXPECT_EQ(stage.mesh(stage.add(scenes::sheet(12, 0.2), {})).tree.bulge, 0.0f);
}

TEST(TriangleTree, ClosestPointIsThatOfAllTrianglesWithAndWithoutAHint) {
  Stage stage;
  Random random(2);
  for (const Primitive& shape : shapes()) {
    const Mesh& mesh = stage.mesh(stage.add(shape, {}));
    const double L = static_cast<double>(mesh.box.diagonal());
    for (int n = 0; n < 3000; ++n) {
      const uvec3 t = mesh.triangles[random.below(mesh.triangles.size())];
      const dvec3 x = dvec3(mesh.position(t.x)) + (n % 3 == 0 ? 0.6 : n % 3 == 1 ? 0.03 : 1e-5) * L * random.in_cube();
      const double within = n % 7 == 0 ? 0.02 * L : L;
      FlatPoint best;
      for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k)
        if (const FlatPoint p = closest_on_triangle(mesh, k, x); p.distance2 < best.distance2) best = p;
      if (best.distance2 > within * within) best = {};
      const FlatPoint free = closest_flat(mesh, x, within);
      const FlatPoint hinted = closest_flat(mesh, x, within, random.below(mesh.triangles.size()));
      ASSERT_EQ(free.valid(), best.valid());
      ASSERT_EQ(hinted.valid(), best.valid());
      if (!best.valid()) continue;
      ASSERT_EQ(free.distance2, best.distance2) << n;
      ASSERT_EQ(hinted.distance2, best.distance2) << n;
    }
  }
}

TEST(TriangleTree, EightDistancesAtOnceDifferFromOneByLessThanTheRoundingAllowed) {
  Stage stage;
  Random random(3);
  for (const Primitive& shape : shapes()) {
    const Mesh& mesh = stage.mesh(stage.add(shape, {}));
    const double L = static_cast<double>(mesh.box.diagonal());
    double worst = 0;
    for (int n = 0; n < 20000; ++n) {
      const std::uint32_t count = 1 + random.below(kTreeNodeWidth);
      const std::uint32_t first = random.below(mesh.triangles.size() - count);
      const double far = std::pow(10.0, 3.0 * random.unit() - 3.0);
      const dvec3 x = dvec3(mesh.position(mesh.triangles[first].x)) + far * L * random.in_cube();
      TriangleDistances d2;
      triangle_distances2(mesh, first, count, x, d2);
      for (std::uint32_t l = 0; l < kTreeNodeWidth; ++l) {
        if (l >= count) {
          ASSERT_TRUE(std::isinf(d2[l]));
          continue;
        }
        const double exact = std::sqrt(closest_on_triangle(mesh, first + l, x).distance2);
        worst = std::max(worst, std::abs(std::sqrt(static_cast<double>(d2[l])) - exact) / rounding(mesh, x));
      }
    }
    EXPECT_LT(worst, 1.0);
  }
}

TEST(TriangleTree, ASegmentMeetsTheRunsOfTheTrianglesThatItCrosses) {
  Stage stage;
  Random random(4);
  for (const Primitive& shape : shapes()) {
    const Mesh& mesh = stage.mesh(stage.add(shape, {}));
    const dvec3 size(mesh.box.size());
    for (int n = 0; n < 1000; ++n) {
      // Through points of the surface, some along an axis, whose other two directions do not move.
      const std::uint32_t through = random.below(mesh.triangles.size());
      const Corner3 c = corners(mesh, through);
      const dvec3 middle = (c.p[0] + c.p[1] + c.p[2]) / 3.0;
      dvec3 way = length(size) * random.in_cube();
      if (n % 4 == 0) way = {0, way.y, 0};
      std::set<std::uint32_t> met;
      visit_along(
          mesh, middle - way, middle + 0.5 * way, [] { return 1.0; }, [&](std::uint32_t t) { met.insert(t); });
      ASSERT_TRUE(met.count(through)) << n;
      const Entry entry = first_entry(mesh, middle - way, middle + 0.5 * way);
      if (entry.valid()) ASSERT_TRUE(met.count(entry.triangle));
    }
  }
}

}  // namespace
}  // namespace pliant
