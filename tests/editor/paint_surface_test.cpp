// The painted surface against closed forms: geodesics, the borders that they do not cross, rays, and the file vertices
// of a welded vertex.
#include "editor/paint/paint_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "tests/editor/paint_shapes.h"

namespace pliant {
namespace {

using namespace test;

constexpr double kWorst = 0.05;  // [1] of the radius

SurfaceHit from_above(const PaintSurface& surface, double x, double y) {
  return surface.hit({{x, y, 10}, {0, 0, -1}});
}

TEST(PaintSurface, DistancesOnASphereAreArcsWhereverTheBrushIsAndHoweverLarge) {
  const PaintSurface surface = surface_of(icosphere(5));
  std::mt19937 random(1);
  std::normal_distribution<double> any;
  for (const double radius : {0.1, 0.3, 1.0, 2.0})
    for (int i = 0; i < 10; ++i) {
      const dvec3 from = normalize(dvec3(any(random), any(random), any(random)));
      const SurfaceHit hit = surface.hit({3.0 * from, -from});
      ASSERT_TRUE(hit.valid());
      const auto arc = [&](vec3 p) { return std::acos(std::clamp(dot(from, normalize(dvec3(p))), -1.0, 1.0)); };
      EXPECT_LT(worst_distance(surface, hit, radius, arc), kWorst) << radius;
    }
}

TEST(PaintSurface, DistancesOnAFlatSheetAreExactWhateverTheTriangles) {
  for (const float uneven : {0.0f, 0.15f, 0.24f})
    for (const vec3& stretch : {vec3(1), vec3(1, 0.1f, 1)}) {
      Primitive p = uneven_sheet(60, uneven);
      for (vec3& x : p.position) x *= stretch;
      const PaintSurface surface = surface_of(p);
      const SurfaceHit hit = from_above(surface, 0.413, 0.527 * double(stretch.y));
      ASSERT_TRUE(hit.valid());
      const auto straight = [&](vec3 x) { return length(dvec3(x) - hit.point); };
      EXPECT_LT(worst_distance(surface, hit, 0.25, straight), 0.005) << uneven << ' ' << stretch.y;
    }
}

TEST(PaintSurface, DistancesOverAFoldAreThoseOfTheSheetUnrolled) {
  const Primitive flat = uneven_sheet(60, 0.2f);
  for (const double turn : {0.5, 1.5, 2.8}) {
    Primitive p = flat;
    for (vec3& x : p.position)
      if (std::abs(x.x - 0.5f) < 0.5f / 60) x.x = 0.5f;  // a row of vertices on the fold
    std::vector<vec3> rolled = p.position;
    for (vec3& x : p.position) x = folded(x, 0.5, turn);
    const PaintSurface surface = surface_of(p);
    // 5 cm before the fold.
    const SurfaceHit hit = surface.closest({0.45, 0.5, 0.0}, 0.01);
    ASSERT_TRUE(hit.valid());
    const auto unrolled = [&](vec3 x) {
      for (std::size_t i = 0; i < rolled.size(); ++i)
        if (p.position[i] == x) return std::hypot(double(rolled[i].x) - 0.45, double(rolled[i].y) - 0.5);
      return -1e9;
    };
    EXPECT_LT(worst_distance(surface, hit, 0.3, unrolled), kWorst) << turn;
  }
}

// Three faces around a corner of a cube are a cone of 270 degrees.
TEST(PaintSurface, DistancesAroundTheCornerOfABoxAreThoseOfItsCone) {
  const PaintSurface surface = surface_of(grid_cube(32));
  const dvec3 tip(1, 1, 1);
  const SurfaceHit hit = from_above(surface, 0.8, 0.7);
  const auto angle = [](dvec3 p) {  // about the corner, by the face that p lies on
    const dvec3 d = dvec3(1) - p;
    constexpr double quarter = std::numbers::pi / 2;
    if (d.z < 1e-6) return std::atan2(d.y, d.x);
    if (d.x < 1e-6) return quarter + std::atan2(d.z, d.y);
    return 2 * quarter + std::atan2(d.x, d.z);
  };
  const auto over_cone = [&](vec3 at) {
    const dvec3 p(at);
    if (std::min({1 - p.x, 1 - p.y, 1 - p.z}) > 1e-6) return 9.0;  // a face behind
    const double around = std::abs(angle(p) - angle(hit.point));
    const double turn = std::min(around, 1.5 * std::numbers::pi - around);
    const double a = length(p - tip), b = length(hit.point - tip);
    return std::sqrt(a * a + b * b - 2 * a * b * std::cos(turn));
  };
  EXPECT_LT(worst_distance(surface, hit, 0.7, over_cone), kWorst);
}

TEST(PaintSurface, LongTrianglesOfAPlainBoxAreNotInTheWay) {
  const PaintSurface surface = surface_of(box(vec3(1), false));
  const SurfaceHit hit = from_above(surface, 0.1, 0.2);
  MarchWork work;
  const auto reached = surface.footprint(hit, 4.0, {}, work);
  ASSERT_EQ(reached.size(), 8u);
  for (const ReachedVertex& r : reached) {
    const dvec3 p(surface.mesh().position(r.vertex));
    // Above: straight. Below: over the nearer of the two sides, unrolled.
    const double dx = std::abs(p.x - 0.1), dy = std::abs(p.y - 0.2);
    const double exact = p.z > 0 ? std::hypot(dx, dy) : std::min(std::hypot(dx + 2, dy), std::hypot(dx, dy + 2));
    EXPECT_NEAR(double(r.distance), exact, kWorst * 4.0);
  }
}

TEST(PaintSurface, ABrushDoesNotGoThroughAThinDoubleWall) {
  Primitive slab = grid_cube(40);
  for (vec3& p : slab.position) p.z *= 0.001f;
  const PaintSurface surface = surface_of(slab);
  MarchWork work;
  const auto inner = surface.footprint(from_above(surface, 0.1, 0.2), 0.5, {}, work);
  EXPECT_GT(inner.size(), 300u);
  for (const ReachedVertex& r : inner) EXPECT_GT(surface.mesh().position(r.vertex).z, 0.0f);
  for (const std::uint32_t t : surface.triangles_under(from_above(surface, 0.1, 0.2), 0.5, work))
    for (int i = 0; i < 3; ++i) EXPECT_GT(surface.mesh().position(surface.mesh().triangles[t][i]).z, 0.0f);
  // Near the rim the path goes around it.
  bool below = false;
  for (const ReachedVertex& r : surface.footprint(from_above(surface, 0.9, 0.2), 0.5, {}, work))
    below = below || surface.mesh().position(r.vertex).z < 0.0f;
  EXPECT_TRUE(below);
}

TEST(PaintSurface, ABrushDoesNotLeapAGap) {
  Primitive left = sheet(20), right = sheet(20);
  for (vec3& p : right.position) p.x += 1.0001f;
  LevelMesh mesh{"two", {left, right}};
  const PaintSurface surface = surface_of(mesh);
  EXPECT_EQ(surface.part_count(), 2u);
  MarchWork work;
  const SurfaceHit hit = from_above(surface, 0.99, 0.5);
  const auto reached = surface.footprint(hit, 0.4, {}, work);
  EXPECT_GT(reached.size(), 80u);
  for (const ReachedVertex& r : reached) EXPECT_LE(surface.mesh().position(r.vertex).x, 1.0f);
  EXPECT_EQ(surface.connected(hit).size(), 21u * 21u);
  EXPECT_EQ(surface.part_of(hit.triangle), surface.part_of(from_above(surface, 0.1, 0.1).triangle));
  EXPECT_NE(surface.part_of(hit.triangle), surface.part_of(from_above(surface, 1.5, 0.1).triangle));
}

TEST(PaintSurface, TheCreaseMaskStopsAtCreasesAndThePrimitiveMaskAtThePrimitive) {
  const PaintSurface cube = surface_of(grid_cube(16));
  MarchWork work;
  const SurfaceHit top = from_above(cube, 0.7, 0.1);
  std::set<float> heights;
  for (const ReachedVertex& r : cube.footprint(top, 0.8, {.creases = true}, work))
    heights.insert(cube.mesh().position(r.vertex).z);
  EXPECT_EQ(heights, std::set<float>{1.0f});
  EXPECT_EQ(cube.connected(top, {.creases = true}).size(), 17u * 17u);
  EXPECT_EQ(cube.connected(top).size(), cube.mesh().vertex_count);
  bool down = false;
  for (const ReachedVertex& r : cube.footprint(top, 0.8, {}, work))
    down = down || cube.mesh().position(r.vertex).z < 1.0f;
  EXPECT_TRUE(down);
  // On the flat face the mask changes no distance.
  const auto straight = [&](vec3 p) { return p.z == 1.0f ? length(dvec3(p) - top.point) : 9.0; };
  EXPECT_LT(worst_distance(cube, top, 0.6, straight, {.creases = true}), 0.005);

  Primitive left = sheet(20), right = sheet(20);
  for (vec3& p : right.position) p.x += 1.0f;
  const PaintSurface both = surface_of(LevelMesh{"two", {left, right}});
  const SurfaceHit hit = both.hit({{0.95, 0.5, 1}, {0, 0, -1}});
  float farthest = 0.0f, farther = 0.0f;
  for (const ReachedVertex& r : both.footprint(hit, 0.3, {}, work))
    farther = std::max(farther, both.mesh().position(r.vertex).x);
  for (const ReachedVertex& r : both.footprint(hit, 0.3, {.primitive = true}, work))
    farthest = std::max(farthest, both.mesh().position(r.vertex).x);
  EXPECT_GT(farther, 1.1f);
  EXPECT_EQ(farthest, 1.0f);
  EXPECT_EQ(both.of_primitive(0).size(), 21u * 21u);
  EXPECT_EQ(both.connected(hit, {.primitive = true}), both.of_primitive(0));
}

// A crease that ends within the surface: the path around its end is open, the path across it is not.
TEST(PaintSurface, AroundTheEndOfACreaseTheWayIsAsLongAsItIs) {
  Primitive p = sheet(40);
  for (vec3& x : p.position) {
    const float ramp = std::max(0.0f, x.y - 0.5f);  // no ridge at y < 0.5, a steep one at y = 1
    x.z = 12.0f * ramp * std::max(0.0f, 0.05f - std::abs(x.x - 0.5f));
  }
  const PaintSurface surface = surface_of(p);
  const SurfaceHit hit = from_above(surface, 0.4, 0.98);
  MarchWork work;
  const auto across = [&](const PaintMask& mask, double radius) {
    for (const ReachedVertex& r : surface.footprint(hit, radius, mask, work))
      if (surface.mesh().position(r.vertex).x > 0.56f && surface.mesh().position(r.vertex).y > 0.9f) return true;
    return false;
  };
  EXPECT_TRUE(across({}, 0.7));
  EXPECT_FALSE(across({.creases = true}, 0.7));
  EXPECT_TRUE(across({.creases = true}, 1.5));
}

TEST(PaintSurface, RaysMeetTheNearestFrontFaceAsBruteForceFindsIt) {
  Primitive two = icosphere(2);
  const auto inner = static_cast<std::uint32_t>(two.position.size());
  for (const vec3& p : icosphere(2).position) two.position.push_back(0.5f * p + vec3(0.3f, 0, 0));
  for (const std::uint32_t v : icosphere(2).index) two.index.push_back(inner + v);
  const PaintSurface surface = surface_of(two);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> any(-2.0, 2.0);
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray{{any(random), any(random), any(random)}, {any(random), any(random), any(random)}};
    double front = INFINITY, back = INFINITY;
    for (const uvec3& t : surface.mesh().triangles) {
      const dvec3 a(surface.mesh().position(t.x)), b(surface.mesh().position(t.y)), c(surface.mesh().position(t.z));
      const dvec3 n = cross(b - a, c - a);
      const double s = dot(a - ray.origin, n) / dot(ray.direction, n);
      const dvec3 x = ray.origin + s * ray.direction;
      if (s < 0 || dot(cross(b - a, x - a), n) < 0 || dot(cross(c - b, x - b), n) < 0 ||
          dot(cross(a - c, x - c), n) < 0)
        continue;
      double& nearest = dot(ray.direction, n) < 0 ? front : back;
      nearest = std::min(nearest, s);
    }
    const auto expect = [&](const SurfaceHit& hit, double s, bool from_behind) {
      ASSERT_EQ(hit.valid(), s < INFINITY);
      if (!hit.valid()) return;
      EXPECT_EQ(hit.back, from_behind);
      EXPECT_LT(length(hit.point - (ray.origin + s * ray.direction)), 1e-5);
    };
    expect(surface.hit(ray), front < INFINITY ? front : back, front == INFINITY);
    expect(surface.hit(ray, true), std::min(front, back), back < front);
    met += front < INFINITY;
  }
  EXPECT_GT(met, 100);
  EXPECT_FALSE(surface.hit({{5, 0, 0}, {1, 0, 0}}).valid());
  EXPECT_FALSE(surface.hit({{5, 0, 0}, {0, 0, 0}}).valid());
  EXPECT_FALSE(surface.hit({{NAN, 0, 0}, {1, 0, 0}}).valid());
  EXPECT_TRUE(surface.hit({{1e6, 0.01, 0.02}, {-1, 0, 0}}).valid());
}

TEST(PaintSurface, AHitNamesThePrimitiveAndTheTriangleOfTheFile) {
  Primitive right = sheet(4);
  for (vec3& p : right.position) p.x += 1.0f;
  const LevelMesh mesh{"two", {unshared(sheet(5)), right}};
  for (const dmat3& frame : {dmat3(1), dmat3(2, 0, 0, 0, 0.5, 0, 0, 0, -1)}) {
    const PaintSurface surface = surface_of(mesh, frame);
    for (const double x : {0.13, 0.57, 1.33, 1.91}) {
      const SurfaceHit hit = surface.hit({frame * dvec3(x, 0.37, 4), frame * dvec3(0, 0, -1)});
      ASSERT_TRUE(hit.valid());
      EXPECT_EQ(hit.source.primitive, x < 1 ? 0u : 1u);
      const Primitive& p = mesh.primitives[hit.source.primitive];
      dvec3 low(9), high(-9);
      for (std::uint32_t k = 0; k < 3; ++k) {
        low = glm::min(low, dvec3(p.position[p.index[3 * hit.source.triangle + k]]));
        high = glm::max(high, dvec3(p.position[p.index[3 * hit.source.triangle + k]]));
      }
      EXPECT_TRUE(low.x <= x && x <= high.x && low.y <= 0.37 && 0.37 <= high.y);
      EXPECT_LT(length(hit.point - frame * dvec3(x, 0.37, 0)), 1e-6);
      EXPECT_NEAR(hit.barycentric.x + hit.barycentric.y + hit.barycentric.z, 1.0, 1e-12);
    }
  }
}

TEST(PaintSurface, ARadiusIsInMetresOfTheWorldHoweverTheNodeIsScaled) {
  const PaintSurface surface = surface_of(sheet(50), dmat3(0.1, 0, 0, 0, 0.2, 0, 0, 0, 1));
  const SurfaceHit hit = surface.hit({{0.05, 0.1, 1}, {0, 0, -1}});
  const auto straight = [&](vec3 x) { return length(dvec3(x) - hit.point); };
  EXPECT_LT(worst_distance(surface, hit, 0.04, straight), 0.005);
  EXPECT_FALSE(PaintSurface::make(LevelMesh{"flat", {sheet(2)}}, dmat3(1, 0, 0, 0, 0, 0, 0, 0, 1)).ok());
}

TEST(PaintSurface, EveryVertexOfTheFileStandsBehindExactlyOneWeldedVertexAtItsPlace) {
  const LevelMesh mesh{"two", {unshared(icosphere(2)), icosphere(2)}};
  LevelMesh moved = mesh;
  for (vec3& p : moved.primitives[1].position) p.x += 5.0f;
  for (const LevelMesh& m : {mesh, moved}) {
    const PaintSurface surface = surface_of(m);
    std::size_t count = 0;
    for (std::uint32_t v = 0; v < surface.mesh().vertex_count; ++v)
      for (const SourceVertex& source : surface.sources(v)) {
        EXPECT_EQ(m.primitives[source.primitive].position[source.index], surface.mesh().position(v));
        EXPECT_EQ(surface.welded(source), v);
        ++count;
      }
    EXPECT_EQ(count, m.primitives[0].position.size() + m.primitives[1].position.size());
  }
}

TEST(PaintSurface, ABoxHoldsItsVerticesOrElseTheNearestOne) {
  const PaintSurface surface = surface_of(sheet(10));
  const auto held = surface.in_box({{0.25f, 0.25f, -1}, {0.55f, 0.35f, 1}});
  EXPECT_EQ(held.size(), 3u * 1u);
  const auto nearest = surface.in_box({{0.31f, 0.42f, 0.1f}, {0.32f, 0.43f, 0.2f}});
  ASSERT_EQ(nearest.size(), 1u);
  EXPECT_LT(length(surface.mesh().position(nearest[0]) - vec3(0.3f, 0.4f, 0)), 1e-6f);
}

TEST(PaintSurface, ItStopsOnRequest) {
  std::atomic<bool> stop{true};
  EXPECT_FALSE(PaintSurface::make(LevelMesh{"mesh", {icosphere(3)}}, dmat3(1), &stop).ok());
  stop = false;
  EXPECT_TRUE(PaintSurface::make(LevelMesh{"mesh", {icosphere(3)}}, dmat3(1), &stop).ok());
}

TEST(PaintSurface, AMillionTrianglesWork) {
  const PaintSurface surface = surface_of(sheet(708));
  EXPECT_GT(surface.mesh().triangles.size(), 1000000u);
  const SurfaceHit hit = from_above(surface, 0.5003, 0.4997);
  const auto straight = [&](vec3 x) { return length(dvec3(x) - hit.point); };
  EXPECT_LT(worst_distance(surface, hit, 0.056, straight), 0.005);
}

}  // namespace
}  // namespace pliant
