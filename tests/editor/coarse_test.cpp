// Whether a mesh is fine enough, and what refining at one place preserves.
#include "editor/paint/coarse.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "editor/paint/stroke.h"
#include "tests/editor/paint_shapes.h"

namespace pliant {
namespace {

using namespace test;

Ray down(double x, double y) {
  return {{x, y, 10}, {0, 0, -1}};
}

double longest_within(const LevelMesh& mesh, const SurfaceHit& hit, double radius, const dmat3& frame = dmat3(1)) {
  const PaintSurface surface = surface_of(mesh, frame);
  MarchWork work;
  double longest = 0.0;
  for (const std::uint32_t t : surface.triangles_under(surface.closest(hit.point, 1.0), radius, work))
    for (int i = 0; i < 3; ++i) {
      const uvec3 c = surface.mesh().triangles[t];
      longest = std::max(longest,
                         length(dvec3(surface.mesh().position(c[(i + 1) % 3])) - dvec3(surface.mesh().position(c[i]))));
    }
  return longest;
}

TEST(Coarse, ItSaysSoWithNumbersWhereEdgesAreTooLongForTheBrushAndOnlyThere) {
  const PaintSurface surface = surface_of(sheet(100));  // edges of 10 mm, diagonals of 14.1 mm
  MarchWork work;
  const SurfaceHit hit = surface.hit(down(0.503, 0.501));
  EXPECT_FALSE(coarse_for({.radius = 0.0284}, surface, hit, work)) << "twice the diagonal and more";
  const auto coarse = coarse_for({.radius = 0.02}, surface, hit, work);
  ASSERT_TRUE(coarse);
  EXPECT_NEAR(coarse->edge, std::sqrt(2e-4), 1e-6);
  for (const char* number : {"14.1 mm", "20 mm", "10 mm", "28.3 mm"})
    EXPECT_NE(coarse->sentence.find(number), std::string::npos) << coarse->sentence;
  EXPECT_TRUE(coarse_for({.radius = 1e-5}, surface, hit, work)) << "a brush within one triangle";
}

TEST(Refine, UnderTheBrushEdgesGetShortAndTheRestOfTheMeshStaysBitForBit) {
  const LevelMesh mesh{"sheet", {sheet(20)}};
  const PaintSurface surface = surface_of(mesh);
  const SurfaceHit hit = surface.hit(down(0.52, 0.47));
  const auto refined = refine_under(mesh, surface, hit, 0.1, 0.01);
  ASSERT_TRUE(refined.ok());
  EXPECT_LE(longest_within(refined->mesh, hit, 0.08), 0.01 * 1.0001);
  EXPECT_EQ(refined->triangles_before, 800u);
  EXPECT_GT(refined->triangles_after, 2000u);
  EXPECT_LT(refined->triangles_after, 8000u) << "the whole sheet would be 40000";

  const Primitive &before = mesh.primitives[0], &after = refined->mesh.primitives[0];
  for (std::size_t i = 0; i < before.position.size(); ++i) {
    EXPECT_EQ(after.position[i], before.position[i]);
    EXPECT_EQ(after.uv[i], before.uv[i]);
  }
  std::set<std::array<std::uint32_t, 3>> triangles;
  for (std::size_t i = 0; i < after.index.size(); i += 3)
    triangles.insert({after.index[i], after.index[i + 1], after.index[i + 2]});
  for (std::size_t i = 0; i < before.index.size(); i += 3) {
    double nearest = 9.0;
    for (std::size_t k = 0; k < 3; ++k)
      nearest = std::min(nearest, length(dvec3(before.position[before.index[i + k]]) - hit.point));
    if (nearest > 0.1 + 4 * 0.0708)
      EXPECT_TRUE(triangles.count({before.index[i], before.index[i + 1], before.index[i + 2]}));
  }
  // A second refinement changes nothing.
  const PaintSurface finer = surface_of(refined->mesh);
  const auto again = refine_under(refined->mesh, finer, finer.hit(down(0.52, 0.47)), 0.1, 0.01);
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again->triangles_after, again->triangles_before) << again->sentence;
}

TEST(Refine, WhatVerticesCarryIsInterpolated) {
  Primitive p = sheet(10);
  for (const vec3& x : p.position) {
    p.normal.emplace_back(0, 0, 1);
    p.tangent.emplace_back(1, 0, 0, 1);
    p.stiffness.push_back(1 + 3 * x.x + 2 * x.y);
    p.pinned.push_back(x.y);
  }
  const LevelMesh mesh{"sheet", {p}};
  const PaintSurface surface = surface_of(mesh);
  const auto refined = refine_under(mesh, surface, surface.hit(down(0.4, 0.6)), 0.15, 0.02);
  ASSERT_TRUE(refined.ok());
  const Primitive& after = refined->mesh.primitives[0];
  EXPECT_GT(after.position.size(), 300u);
  for (std::size_t i = 0; i < after.position.size(); ++i) {
    const vec3 x = after.position[i];
    EXPECT_LT(std::abs(x.z), 1e-6f);
    EXPECT_LT(length(after.uv[i] - vec2(x)), 1e-5f);
    EXPECT_LT(length(after.normal[i] - vec3(0, 0, 1)), 1e-5f);
    EXPECT_LT(length(after.tangent[i] - vec4(1, 0, 0, 1)), 1e-5f);
    EXPECT_NEAR(after.stiffness[i], 1 + 3 * x.x + 2 * x.y, 1e-5f);
    EXPECT_NEAR(after.pinned[i], x.y, 1e-5f);
  }
  EXPECT_TRUE(after.friction.empty());
}

TEST(Refine, ASphereStaysRoundAndClosedAcrossSeamsAndPrimitives) {
  // Two halves, every triangle with its own vertices.
  const Primitive whole = unshared(icosphere(2));
  LevelMesh mesh{"sphere", {whole, whole}};
  for (Primitive& p : mesh.primitives) p.index.clear();
  for (std::size_t i = 0; i < whole.index.size(); i += 3) {
    const float x =
        whole.position[whole.index[i]].x + whole.position[whole.index[i + 1]].x + whole.position[whole.index[i + 2]].x;
    auto& index = mesh.primitives[x > 0 ? 1 : 0].index;
    index.insert(index.end(), whole.index.begin() + std::ptrdiff_t(i), whole.index.begin() + std::ptrdiff_t(i) + 3);
  }
  for (const dmat3& frame : {dmat3(1), dmat3(0.1, 0, 0, 0, 0.2, 0, 0, 0, 0.1)}) {
    const PaintSurface surface = surface_of(mesh, frame);
    const SurfaceHit hit = surface.hit({frame * dvec3(0.02, 0.1, 5), {0, 0, -1}});
    const auto refined = refine_under(mesh, surface, hit, 0.03, 0.004);
    ASSERT_TRUE(refined.ok());
    EXPECT_LE(longest_within(refined->mesh, hit, 0.02, frame), 0.004 * 1.0001);
    const auto built = build_mesh("sphere", refined->mesh.primitives, mat4(1));
    ASSERT_TRUE(built.ok());
    EXPECT_TRUE(built->mesh.closed) << built->report.border_edges << " borders";
    EXPECT_EQ(built->report.degenerate_triangles, 0u);
    for (std::uint32_t v = 0; v < built->mesh.vertex_count; ++v)
      EXPECT_NEAR(length(built->mesh.position(v)), 1.0f, 2e-3f);
    EXPECT_NEAR(enclosed_volume(built->mesh), 4.19, 0.3);
  }
}

TEST(Refine, WhatIsBehindAThinWallStaysAsItIs) {
  Primitive slab = grid_cube(10);
  for (vec3& p : slab.position) p.z *= 0.001f;
  const LevelMesh mesh{"slab", {slab}};
  const PaintSurface surface = surface_of(mesh);
  const auto refined = refine_under(mesh, surface, surface.hit(down(0.05, 0.03)), 0.1, 0.02);
  ASSERT_TRUE(refined.ok());
  std::size_t above = 0, below = 0;
  const Primitive& p = refined->mesh.primitives[0];
  for (std::size_t i = 0; i < p.index.size(); i += 3) {
    float z = 0;
    for (std::size_t k = 0; k < 3; ++k) z += p.position[p.index[i + k]].z;
    above += z > 0.0029f, below += z < -0.0029f;
  }
  EXPECT_EQ(below, 200u);
  EXPECT_GT(above, 1000u);
}

TEST(Refine, TrianglesThatAreNotTouchedStayInTheFile) {
  Primitive p = sheet(4);
  const std::vector<std::uint32_t> degenerate{0, 0, 1}, again{p.index[0], p.index[1], p.index[2]};
  p.index.insert(p.index.end(), degenerate.begin(), degenerate.end());
  p.index.insert(p.index.end(), again.begin(), again.end());
  const LevelMesh mesh{"sheet", {p}};
  const PaintSurface surface = surface_of(mesh);
  const auto refined = refine_under(mesh, surface, surface.hit(down(0.8, 0.8)), 0.05, 0.05);
  ASSERT_TRUE(refined.ok());
  const std::vector<std::uint32_t>& index = refined->mesh.primitives[0].index;
  EXPECT_TRUE(std::equal(again.rbegin(), again.rend(), index.rbegin()));
  EXPECT_TRUE(std::equal(degenerate.rbegin(), degenerate.rend(), index.rbegin() + 3));
}

TEST(Refine, WhatWouldBeTooMuchIsSaid) {
  const LevelMesh mesh{"sheet", {sheet(4)}};
  const PaintSurface surface = surface_of(mesh);
  const SurfaceHit hit = surface.hit(down(0.5, 0.51));
  const auto refined = refine_under(mesh, surface, hit, 10.0, 1e-5);
  ASSERT_TRUE(refined.ok());
  EXPECT_LT(refined->triangles_after, 400000u);
  EXPECT_NE(refined->sentence.find("262144"), std::string::npos) << refined->sentence;
  EXPECT_FALSE(refine_under(mesh, surface, hit, 0.1, 0.0).ok());

  const LevelMesh large{"sheet", {sheet(400)}};
  const PaintSurface of_large = surface_of(large);
  const auto nothing = refine_under(large, of_large, of_large.hit(down(0.5, 0.51)), 10.0, 1e-3);
  ASSERT_TRUE(nothing.ok());
  EXPECT_EQ(nothing->triangles_after, 320000u);
  EXPECT_NE(nothing->sentence.find("262144"), std::string::npos) << nothing->sentence;
}

TEST(Refine, AfterItTheBrushFindsEnoughVertices) {
  Primitive cube = box(vec3(1), true);
  const LevelMesh mesh{"box", {cube}};
  const PaintSurface surface = surface_of(mesh);
  MarchWork work;
  const SurfaceHit hit = surface.hit(down(0.3, 0.2));
  const Brush brush{.radius = 0.1, .value = 5.0};
  EXPECT_TRUE(surface.footprint(hit, brush.radius, {}, work).empty());
  const auto coarse = coarse_for(brush, surface, hit, work);
  ASSERT_TRUE(coarse);
  const auto refined = refine_under(mesh, surface, hit, brush.radius, coarse->wanted);
  ASSERT_TRUE(refined.ok());
  const PaintSurface finer = surface_of(refined->mesh);
  const SurfaceHit now = finer.hit(down(0.3, 0.2));
  EXPECT_LT(length(now.point - hit.point), 1e-6) << "a flat face stays flat";
  EXPECT_FALSE(coarse_for(brush, finer, now, work));
  Stroke stroke(finer, paint_of(refined->mesh, finer, PaintAttribute::kStiffness), brush);
  EXPECT_GT(stroke.move(down(0.3, 0.2)).values.size(), 10u);
  EXPECT_GT(value_probe(stroke.after(), finer, now), 4.0);
}

}  // namespace
}  // namespace pliant
