#include "systems/touch/collide/surface_query.h"

#include <gtest/gtest.h>

#include <random>

#include "scenes/scenes.h"

namespace pliant {
namespace {

using scenes::Stage;

TEST(VirtualVertex, LiesOnTheInterpolatedNormalThroughThePoint) {
  Stage stage;
  const Entity ball = stage.add(scenes::sphere(8, 0.1), {});
  const Mesh& mesh = stage.mesh(ball);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int n = 0; n < 5000; ++n) {
    const std::uint32_t t = static_cast<std::uint32_t>(random() % mesh.triangles.size());
    double u = unit(random), v = unit(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const double height = 0.08 * (unit(random) - 0.5);
    const SurfaceFoot truth = surface_point(corners(mesh, t), t, {1 - u - v, u, v}, height);
    const SurfaceFoot p = virtual_vertex(mesh, t, truth.foot + height * truth.normal);
    ASSERT_TRUE(p.valid());
    EXPECT_NEAR(p.height, height, 1e-12);
    EXPECT_LT(length(p.foot - truth.foot), 1e-11);
    EXPECT_LT(length(p.normal - truth.normal), 1e-9);
  }
}

TEST(VirtualVertex, DoesNotExistBeyondTheFocalDistance) {
  Stage stage;
  const Entity ball = stage.add(scenes::sphere(8, 0.1), {});
  const Mesh& mesh = stage.mesh(ball);
  const Corner3 c = corners(mesh, 0);
  const SurfaceFoot middle = surface_point(c, 0, {0.3, 0.3, 0.4}, 0);
  EXPECT_TRUE(virtual_vertex(mesh, 0, middle.foot - 0.05 * middle.normal).valid());
  EXPECT_FALSE(virtual_vertex(mesh, 0, middle.foot - 0.15 * middle.normal).valid());  // the normals meet at 0.1
}

void expect_nearest_matches_brute_force(const Mesh& mesh, int queries, double spread) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const double L = mesh.box.diagonal();
  int mismatches = 0;
  for (int n = 0; n < queries; ++n) {
    const uvec3 t = mesh.triangles[random() % mesh.triangles.size()];
    const dvec3 x = dvec3(mesh.position(t.x)) + spread * L * dvec3(unit(random), unit(random), unit(random));
    const SurfaceFoot fast = nearest(mesh, x, L), slow = nearest_by_brute_force(mesh, x, L);
    if (fast.valid() != slow.valid() || fast.interpolated != slow.interpolated ||
        std::abs(fast.distance() - slow.distance()) > 1e-12 * L)
      ++mismatches;
  }
  EXPECT_EQ(mismatches, 0);
}

TEST(SurfaceQuery, NearestFindsWhatBruteForceFindsOnSheetSphereSlabAndValley) {
  Stage stage;
  for (const Primitive& shape :
       {scenes::sheet(12, 0.2), scenes::sphere(8, 0.1), scenes::slab(10, 0.2, 0.004), scenes::valley(10, 0.2, 0.6)}) {
    const Entity surface = stage.add(shape, {});
    expect_nearest_matches_brute_force(stage.mesh(surface), 1500, 0.05);
    expect_nearest_matches_brute_force(stage.mesh(surface), 300, 0.6);
  }
}

TEST(SurfaceQuery, TrackingAgreesWithTheGlobalSearchAlongASmoothBody) {
  Stage stage;
  const Mesh& mesh = stage.mesh(stage.add(scenes::sphere(24, 0.1), {}));
  SurfaceFoot p = nearest(mesh, {0.0953, 0.01, 0.01}, 1);
  for (int i = 0; i < 2000; ++i) {
    const double a = 0.003 * i, r = 0.096 + 0.003 * std::sin(0.01 * i);
    const dvec3 x = r * normalize(dvec3(std::cos(a), 0.5 * std::sin(0.7 * a), std::sin(a)));
    p = track(mesh, p, x).point;
    const SurfaceFoot best = nearest(mesh, x, 1);
    ASSERT_TRUE(p.valid());
    ASSERT_NEAR(p.height, best.height, 1e-10) << i;
  }
}

TEST(SurfaceQuery, EntryIsFoundThroughVerticesEdgesAndFacesAndOnlyFromOutside) {
  Stage stage;
  const Mesh& mesh = stage.mesh(stage.add(scenes::sheet(8, 0.08), {}));
  for (int i = 1; i < 8; ++i) {
    for (int j = 1; j < 8; ++j) {
      for (const dvec3 offset : {dvec3(0), dvec3(0.005, 0, 0), dvec3(0.0025, 0, 0.0025), dvec3(0.002, 0, 0.0011)}) {
        const dvec3 at = dvec3(-0.04 + 0.01 * i, 0, -0.04 + 0.01 * j) + offset;
        if (std::abs(at.x) > 0.039 || std::abs(at.z) > 0.039) continue;
        const Entry entry = first_entry(mesh, at + dvec3(0.001, 0.03, 0), at - dvec3(0.001, 0.03, 0));
        ASSERT_TRUE(entry.valid()) << i << ' ' << j;
        EXPECT_NEAR(entry.fraction, 0.5, 1e-6);
        EXPECT_FALSE(first_entry(mesh, at - dvec3(0, 0.03, 0), at + dvec3(0, 0.03, 0)).valid());
      }
    }
  }
  EXPECT_FALSE(first_entry(mesh, {0.05, 0.01, 0}, {0.05, -0.01, 0}).valid());  // beside the sheet
}

TEST(SurfaceQuery, FirstEntryIsTheEarliestOfAllCrossings) {
  Stage stage;
  const Mesh& mesh = stage.mesh(stage.add(scenes::sphere(10, 0.1), {}));
  std::mt19937 random(5);
  std::normal_distribution<double> g;
  for (int n = 0; n < 2000; ++n) {
    const dvec3 out = normalize(dvec3(g(random), g(random), g(random)));
    const dvec3 target = 0.09 * normalize(dvec3(g(random), g(random), g(random)));
    const dvec3 from = 0.3 * out, to = from + 1.7 * (target - from);
    const Entry entry = first_entry(mesh, from, to);
    double best = 2;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Corner3 c = corners(mesh, t);
      const dvec3 normal = cross(c.p[1] - c.p[0], c.p[2] - c.p[0]);
      const double facing = dot(normal, to - from);
      if (facing >= 0) continue;
      const double s = dot(normal, c.p[0] - from) / facing;
      const dvec3 x = from + s * (to - from);
      bool inside = s >= 0 && s <= 1;
      for (int e = 0; e < 3; ++e) inside &= dot(cross(c.p[(e + 1) % 3] - c.p[e], x - c.p[e]), normal) >= -1e-16;
      if (inside) best = std::min(best, s);
    }
    ASSERT_EQ(entry.valid(), best <= 1) << n;
    if (entry.valid()) ASSERT_NEAR(entry.fraction, best, 1e-9);
  }
}

TEST(SurfaceQuery, TrackingSaysWhenAProbeHasLeftTheRimOfASheet) {
  Stage stage;
  const Mesh& mesh = stage.mesh(stage.add(scenes::sheet(8, 0.08), {}));
  SurfaceFoot p = nearest(mesh, {0.035, -0.002, 0}, 1);
  Tracked on = track(mesh, p, {0.0399, -0.002, 0});
  EXPECT_FALSE(on.left_border);
  EXPECT_NEAR(on.point.height, -0.002, 1e-9);
  EXPECT_TRUE(track(mesh, on.point, {0.0411, -0.002, 0}).left_border);
}

}  // namespace
}  // namespace pliant
