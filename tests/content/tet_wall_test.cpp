// Surfaces that are not plain solids, as tissue: double walls, open sheets, fins, small parts. Against volumes in
// closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "content/level/soft_preview.h"
#include "content/level/spawn_soft.h"
#include "content/tets/step_cost.h"
#include "content/tets/tet_boundary.h"
#include "content/tets/tet_parts.h"
#include "content/tets/tet_quality.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using test::icosphere;
using testing::Contains;
using testing::Field;
using testing::HasSubstr;

constexpr double kBall = 4.0 / 3.0 * std::numbers::pi;  // [m3] of radius 1

BuiltMesh built(const std::vector<Primitive>& primitives) {
  Result<BuiltMesh> mesh = build_mesh("test", primitives, mat4(1.0f));
  EXPECT_TRUE(mesh.ok()) << mesh.error().message();
  return std::move(*mesh);
}

Primitive moved(Primitive p, float scale, vec3 by) {
  for (vec3& v : p.position) v = scale * v + by;
  return p;
}

// A sphere of radius 1 and an inner one that faces into the cavity.
std::vector<Primitive> capsule(float thickness) {
  Primitive inner = moved(icosphere(4), 1.0f - thickness, vec3(0));
  for (std::size_t i = 0; i < inner.index.size(); i += 3) std::swap(inner.index[i], inner.index[i + 1]);
  return {icosphere(4), inner};
}

// The same with an opening about +Y, `half` [rad] to each side, its sheets joined around it: one closed surface.
Primitive jar(double thickness, double half) {
  constexpr std::uint32_t kAround = 48, kRings = 48;
  Primitive p;
  for (const bool inner : {false, true})
    for (std::uint32_t i = 0; i <= kRings; ++i) {
      const double down = half + (std::numbers::pi - half) * (inner ? kRings - i : i) / kRings;
      const double r = inner ? 1.0 - thickness : 1.0;
      for (std::uint32_t j = 0; j < kAround; ++j) {
        const double turn = 2.0 * std::numbers::pi * j / kAround;
        p.position.emplace_back(r * std::sin(down) * std::cos(turn), r * std::cos(down),
                                r * std::sin(down) * std::sin(turn));
      }
    }
  const auto at = [](std::uint32_t ring, std::uint32_t j) { return ring % (2 * kRings + 2) * kAround + j % kAround; };
  for (std::uint32_t ring = 0; ring < 2 * kRings + 2; ++ring) {
    if (ring == kRings) continue;  // both poles are points
    for (std::uint32_t j = 0; j < kAround; ++j)
      for (const std::uint32_t v :
           {at(ring, j), at(ring + 1, j + 1), at(ring + 1, j), at(ring, j), at(ring, j + 1), at(ring + 1, j + 1)})
        p.index.push_back(v);
  }
  return p;
}

TetMesh filled(const BuiltMesh& surface, const LatticeOptions& options = {}) {
  Result<TetMesh> mesh = fill_surface(surface.mesh, options);
  EXPECT_TRUE(mesh.ok()) << mesh.error().message();
  return mesh ? std::move(*mesh) : TetMesh{};
}

TEST(Wall, OfADoubleWallTheInsideIsFilledWhetherItIsClosedOrOpen) {
  for (const auto& [surface, close] :
       {std::pair(built(capsule(0.01f)), 0.04), std::pair(built({jar(0.01, 0.4)}), 0.1)}) {
    const TetMesh mesh = filled(surface);
    EXPECT_NEAR(total_volume(mesh), kBall, close * kBall);
    EXPECT_EQ(count_parts(mesh), 1u);
    EXPECT_GT(mesh.tets.size(), 1600u);
    EXPECT_LT(mesh.tets.size(), 2400u);
    EXPECT_NEAR(mesh.report.wall, 0.01, 0.002);
    EXPECT_THAT(mesh.report.notes, Contains(Field(&Note::what, HasSubstr("is a wall of"))));
  }
}

TEST(Wall, OfAFilledOneOnlyTheOuterSheetIsTouched) {
  for (const float flat : {1.0f, 0.1f}) {  // the latter is thinner than its cells all around
    std::vector<Primitive> sheets = capsule(0.0f);
    for (Primitive& sheet : sheets)
      for (vec3& v : sheet.position) v.y *= flat;
    for (vec3& v : sheets[1].position) v -= 0.04f * flat * normalize(v / vec3(1, flat * flat, 1));
    Level level = test::level_of(sheets[0], {});
    level.meshes[0].primitives = sheets;
    level.nodes[0].deformable.reset();
    level.nodes[0].soft_body = SoftBody{};
    const Result<SoftParts> parts = make_soft_parts(level.nodes[0], &level.meshes[0], mat4(1.0f), {});
    ASSERT_TRUE(parts) << parts.error().message();
    const Mesh& touched = parts->surface.mesh;
    EXPECT_EQ(touched.triangles.size(), icosphere(4).index.size() / 3) << flat;
    for (const uvec3& t : touched.triangles)
      ASSERT_NEAR(length(touched.position(t.x) / vec3(1, flat, 1)), 1.0f, 1e-4f) << flat;
    EXPECT_EQ(parts->tets.embedding.size(), touched.vertex_count);
  }
}

TEST(Wall, ThickWallsStayHollowAndSolidsAreNoWalls) {
  for (const double cell : {0.0, 0.12}) {
    EXPECT_NEAR(total_volume(filled(built(capsule(0.5f)), {cell})), kBall * 0.875, 0.04 * kBall);
    EXPECT_EQ(filled(built(capsule(0.5f)), {cell}).report.wall, 0.0);
    const TetMesh ball = filled(built({icosphere(4)}), {cell});
    EXPECT_EQ(ball.report.wall, 0.0);
    EXPECT_THAT(ball.report.notes, testing::IsEmpty());
  }
}

TEST(Wall, WithAThicknessItIsALayerBehindTheSurface) {
  LatticeOptions options{0.16, Fill::kWall, 0.3, {}};
  const double layer = kBall * (1.0 - 0.7 * 0.7 * 0.7);
  for (const BuiltMesh& surface : {built({icosphere(4)}), built(capsule(0.01f))}) {
    const TetMesh mesh = filled(surface, options);
    EXPECT_NEAR(total_volume(mesh), layer, 0.1 * layer);
    EXPECT_EQ(count_parts(mesh), 1u);
  }
  // Without a given cell, the number of elements is also limited.
  options.cell = 0.0;
  EXPECT_LE(filled(built({icosphere(4)}), options).tets.size(), kMostUsualTets);
}

TEST(Wall, AnOpenSheetGetsItsThicknessInwardsAndIsRefusedWithoutOne) {
  const BuiltMesh sheet = built({test::sheet(8)});
  const vec3 size = sheet.mesh.box.size();
  double area = 1.0;
  for (int i = 0; i < 3; ++i)
    if (size[i] > 0.0f) area *= static_cast<double>(size[i]);
  const double thickness = 0.1 * std::sqrt(area);
  const TetMesh mesh = filled(sheet, {0.4 * thickness, Fill::kWall, thickness, {}});
  EXPECT_NEAR(total_volume(mesh), area * thickness, 0.12 * area * thickness) << "its rim leans out a little";
  const dvec3 normal(sheet.mesh.normal(0)), on(sheet.mesh.position(0));
  for (const dvec3& node : mesh.nodes) EXPECT_LT(dot(node - on, normal), 0.05 * thickness);
  const Result<TetMesh> without = fill_surface(sheet.mesh, {0.0, Fill::kWall, 0.0, {}});
  ASSERT_FALSE(without);
  EXPECT_THAT(without.error().message(), HasSubstr("open surface that encloses nothing; close it, or give it a"));
}

TEST(Wall, ThinnerThanItsCellItIsRefusedWithWhatToDo) {
  SoftBody body;
  body.fill = Fill::kWall;
  const Result<FilledBody> tissue = make_tissue(built(capsule(0.004f)), body, nullptr);
  ASSERT_FALSE(tissue);
  EXPECT_THAT(tissue.error().message(),
              testing::AllOf(HasSubstr("fill the inside (\"fill\": \"solid\")"), HasSubstr("`thickness` of at least")));
}

// A hundred needles in all directions, each thinner than a cell.
TEST(Wall, HoweverThinTheUsualCellKeepsToItsBudget) {
  std::vector<Primitive> needles;
  for (int i = 0; i < 100; ++i) {
    const float z = 1.0f - (2.0f * static_cast<float>(i) + 1.0f) / 100.0f, r = std::sqrt(1.0f - z * z),
                turn = 2.4f * static_cast<float>(i);
    const vec3 tip(r * std::cos(turn), z, r * std::sin(turn));
    const vec3 side = 0.004f * normalize(cross(tip, vec3(0.3f, 0.5f, 0.8f))), up = 0.004f * normalize(cross(tip, side));
    Primitive p;
    p.position = {0.1f * tip + side, 0.1f * tip - side + up, 0.1f * tip - side - up, tip};
    p.index = {0, 1, 3, 1, 2, 3, 2, 0, 3, 0, 2, 1};
    needles.push_back(p);
  }
  const BuiltMesh surface = built(needles);
  const Result<TetMesh> mesh = fill_surface(surface.mesh, {});
  if (mesh) EXPECT_LE(mesh->tets.size(), kMostUsualTets);
  const Result<FilledBody> tissue = make_tissue(surface, SoftBody{}, nullptr);
  ASSERT_FALSE(tissue);
  EXPECT_THAT(tissue.error().message(), HasSubstr("make `cell` smaller"));
}

TEST(Parts, CrumbsAreDroppedUnlessTheyAreHeldAndThatIsSaid) {
  const BuiltMesh surface = built({icosphere(4), moved(icosphere(3), 0.15f, vec3(1.6f, 0, 0))});
  SoftBody body;
  body.cell = 0.1;
  const Result<FilledBody> free = make_tissue(surface, body, nullptr);
  ASSERT_TRUE(free) << free.error().message();
  EXPECT_EQ(free->tets.report.parts_dropped, 1u);
  EXPECT_NEAR(free->tets.report.volume_dropped, 0.15 * 0.15 * 0.15, 2e-3);
  EXPECT_EQ(count_parts(free->tets), 1u);
  EXPECT_EQ(free->group.size(), free->tets.nodes.size());
  for (const dvec3& node : free->tets.nodes) EXPECT_LT(node.x, 1.1);
  EXPECT_THAT(free->tets.report.notes, Contains(Field(&Note::what, HasSubstr("lost 1 part too small to keep"))));
  body.pinned = Box{vec3(1.5f, -1, -1), vec3(2, 1, 1)};
  const Result<FilledBody> held = make_tissue(surface, body, nullptr);
  ASSERT_TRUE(held) << held.error().message();
  EXPECT_EQ(count_parts(held->tets), 2u);
}

TEST(Thin, AFinIsWarnedOfWithACellThatHoldsItAndWithThatNoLonger) {
  const BuiltMesh finned =
      built({icosphere(4), moved(test::box(vec3(0.7f, 0.7f, 0.07f), false), 1.0f, vec3(0, 1.5f, 0))});
  const TetMesh mesh = filled(finned);
  EXPECT_THAT(mesh.report.notes,
              Contains(Field(&Note::what, testing::AllOf(HasSubstr("is thin over"), HasSubstr("14 cm")))));
  EXPECT_NEAR(mesh.report.least_thickness, 0.14, 1e-3);
  EXPECT_GT(mesh.report.thinnest.y, 0.8f);
  EXPECT_EQ(filled(finned, {0.07}).report.notes.size(), 0u);
}

TEST(Preview, SaysWhatARunWouldMakeAndEndsWhenAsked) {
  SoftBody body;
  body.pinned = Box{vec3(-1), vec3(1, -0.5f, 1)};
  const BuiltMesh surface = built(capsule(0.01f));
  const Result<SoftPreview> preview = preview_soft_body(surface, body);
  ASSERT_TRUE(preview) << preview.error().message();
  const Result<FilledBody> tissue = make_tissue(surface, body, nullptr);
  ASSERT_TRUE(tissue);
  EXPECT_EQ(preview->tetrahedra, tissue->tets.tets.size());
  EXPECT_EQ(preview->nodes.size(), tissue->tets.nodes.size());
  EXPECT_GT(preview->pinned, 10u);
  EXPECT_THAT(preview->notes, Contains(Field(&Note::what, HasSubstr("is a wall of"))));
  EXPECT_GT(preview->step_ms, 0.0);
  // Euler: nodes - edges + faces - tetrahedra of one solid part without holes.
  const std::size_t faces = (4 * preview->tetrahedra + boundary_triangles(tissue->tets.tets).size()) / 2;
  EXPECT_EQ(preview->nodes.size() + faces, preview->edges.size() + preview->tetrahedra + 1);
  std::stop_source source;
  source.request_stop();
  const Result<SoftPreview> stopped = preview_soft_body(surface, body, nullptr, source.get_token());
  ASSERT_FALSE(stopped);
  EXPECT_THAT(stopped.error().message(), HasSubstr("was stopped"));
}

// The rows of bench/results/README.md that the model was fitted to.
TEST(StepCost, TheModelIsWithinAQuarterOfWhatWasMeasured) {
  for (const auto& [tets, ms] :
       {std::pair(540, 4.7), std::pair(2016, 6.0), std::pair(10080, 44.0), std::pair(40128, 676.0)})
    EXPECT_NEAR(step_ms(static_cast<std::size_t>(tets), 1.0), ms, 0.25 * ms);
  EXPECT_GT(machine_slowness(), 0.0);
}

}  // namespace
}  // namespace pliant
