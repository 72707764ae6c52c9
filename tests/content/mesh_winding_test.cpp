// Wrong winding: decidable cases are turned, others are counted.
#include "content/mesh/mesh_winding.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "content/validate.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using test::box;
using test::build;
using test::enclosed_volume;
using test::icosphere;
using test::level_of;
using test::sheet;
using test::unshared;

void turn(Primitive& p, std::size_t triangle) {
  std::swap(p.index[3 * triangle + 1], p.index[3 * triangle + 2]);
}
Primitive inside_out(Primitive p) {
  for (std::size_t t = 0; t < p.index.size() / 3; ++t) turn(p, t);
  return p;
}
Primitive placed(Primitive p, float scale, vec3 at) {
  for (vec3& x : p.position) x = x * scale + at;
  return p;
}
Primitive joined(const std::vector<Primitive>& all) {
  Primitive out;
  for (const Primitive& p : all) {
    const auto first = static_cast<std::uint32_t>(out.position.size());
    out.position.insert(out.position.end(), p.position.begin(), p.position.end());
    out.normal.insert(out.normal.end(), p.normal.begin(), p.normal.end());
    for (const std::uint32_t v : p.index) out.index.push_back(first + v);
  }
  return out;
}

void expect_drawn_as_touched(const BuiltMesh& built) {
  for (std::size_t i = 0; i < built.draw.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return built.draw.vertices[built.draw.indices[i + k]]; };
    const vec3 face = cross(at(1).position - at(0).position, at(2).position - at(0).position);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_GT(dot(face, at(k).normal), 0.0f);
      EXPECT_GT(dot(at(k).normal, built.mesh.normal(at(k).touch_vertex)), 0.0f);
    }
  }
}

TEST(MeshWinding, TrianglesAgainstTheirNeighboursAreTurnedToTheLargerArea) {
  const Primitive sound = icosphere(3);
  const double volume = enclosed_volume(build(sound).mesh);
  for (const bool apart : {false, true}) {
    Primitive p = sound;
    std::uint32_t turned = 0;
    for (std::size_t t = 0; t < p.index.size() / 3; ++t)
      if (t % 5 == 0 || (t > 100 && t < 200)) turn(p, t), ++turned;
    const BuiltMesh built = build(apart ? unshared(p) : p);
    EXPECT_EQ(built.report.turned_triangles, turned);
    EXPECT_EQ(built.report.turned_parts + built.report.unorientable_parts + built.report.undecided_parts, 0u);
    EXPECT_TRUE(built.mesh.closed);
    EXPECT_EQ(built.report.non_manifold_edges, 0u);
    EXPECT_NEAR(enclosed_volume(built.mesh), volume, 1e-6 * volume);
    expect_drawn_as_touched(built);
  }
}

TEST(MeshWinding, AnOpenSheetWithOneTriangleTurnedIsMended) {
  Primitive p = sheet(6);
  turn(p, 17);
  const BuiltMesh built = build(p);
  EXPECT_EQ(built.report.turned_triangles, 1u);
  for (std::uint32_t v = 0; v < built.mesh.vertex_count; ++v) EXPECT_EQ(built.mesh.normal(v), vec3(0, 0, 1));
}

TEST(MeshWinding, AClosedPartThatIsInsideOutIsTurnedWithItsNormals) {
  for (const bool normals : {false, true}) {
    Primitive p = icosphere(2);
    if (normals)
      for (const vec3& x : p.position) p.normal.push_back(-x);
    p = inside_out(p);
    for (const vec3& scale : {vec3(1), vec3(-2, 1, 1)}) {  // a mirroring frame does not correct it
      mat4 frame(1.0f);
      for (int i = 0; i < 3; ++i) frame[i] *= scale[i];
      const BuiltMesh built = build(p, frame);
      EXPECT_EQ(built.report.turned_parts, 1u);
      EXPECT_EQ(built.report.turned_triangles, 0u);
      EXPECT_GT(enclosed_volume(built.mesh), 0.0);
      expect_drawn_as_touched(built);
    }
  }
}

TEST(MeshWinding, NormalsThatWereRightStayWhenTheWindingIsTurned) {
  Primitive p = icosphere(2);
  p.normal = p.position;
  const BuiltMesh built = build(inside_out(p));
  EXPECT_EQ(built.report.turned_parts, 1u);
  expect_drawn_as_touched(built);
}

TEST(MeshWinding, TheWallOfACavityStaysAndWhatFloatsInItIsTurned) {
  const Primitive outer = placed(icosphere(3), 1.0f, {5, 0, 0}),
                  wall = inside_out(placed(icosphere(2), 0.7f, {5, 0, 0})),
                  pearl = inside_out(placed(icosphere(1), 0.2f, {5.1f, 0.1f, 0})),
                  beside = inside_out(placed(icosphere(1), 0.5f, {8, 0, 0}));
  const BuiltMesh hollow = build(joined({outer, wall}));
  EXPECT_EQ(hollow.report.turned_parts + hollow.report.undecided_parts, 0u);
  const BuiltMesh built = build(joined({pearl, wall, outer, beside}));
  EXPECT_EQ(built.report.turned_parts, 2u);
  EXPECT_EQ(built.report.undecided_parts, 0u);
  const double whole = enclosed_volume(built.mesh), hollow_volume = enclosed_volume(hollow.mesh);
  EXPECT_NEAR(whole - hollow_volume,
              std::abs(enclosed_volume(build(pearl).mesh)) + std::abs(enclosed_volume(build(beside).mesh)), 1e-5);
  // All inside out: the hollow's outer side is turned, after which its wall is right the other way round too.
  const BuiltMesh reversed = build(joined({inside_out(outer), wall}));
  EXPECT_EQ(reversed.report.turned_parts, 1u);
  EXPECT_NEAR(enclosed_volume(reversed.mesh), hollow_volume, 1e-5);
}

TEST(MeshWinding, APartInsideOutThatCrossesAnotherIsLeftAndNamed) {
  const BuiltMesh built = build(joined({icosphere(3), inside_out(placed(icosphere(2), 0.6f, {0.9f, 0.05f, 0.02f}))}));
  EXPECT_EQ(built.report.turned_parts, 0u);
  EXPECT_EQ(built.report.undecided_parts, 1u);
  EXPECT_THAT(winding_doubt(built.report)->message(), testing::StartsWith("1 part may be inside out"));
}

TEST(MeshWinding, AMoebiusStripIsLeftAsItIsAndNamed) {
  constexpr std::uint32_t kSteps = 40;
  Primitive p;
  for (std::uint32_t i = 0; i < kSteps; ++i)
    for (const double side : {-0.3, 0.3}) {
      const double a = 2 * std::numbers::pi * i / kSteps;
      p.position.emplace_back((1 + side * std::cos(a / 2)) * std::cos(a), side * std::sin(a / 2),
                              (1 + side * std::cos(a / 2)) * std::sin(a));
    }
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * i + 1, twist = i + 1 == kSteps;
    const std::uint32_t c = (2 * i + 2 + twist) % (2 * kSteps), d = (2 * i + 3 - twist) % (2 * kSteps);
    for (const std::uint32_t v : {a, b, c, b, d, c}) p.index.push_back(v);
  }
  std::swap(p.index[0], p.index[1]);
  const BuiltMesh built = build(p);
  EXPECT_EQ(built.report.unorientable_parts, 1u);
  EXPECT_EQ(built.report.turned_triangles + built.report.turned_parts, 0u);
  EXPECT_THAT(winding_doubt(built.report)->message(), testing::StartsWith("1 part has one side only"));
  EXPECT_FALSE(winding_note(built.report));
}

TEST(MeshWinding, AnOpenPartFollowsTheFilesNormalsWhereTheyAgree) {
  Primitive p = inside_out(sheet(4));
  EXPECT_EQ(build(p).report.turned_parts, 0u) << "nothing says which side is meant";
  p.normal.assign(p.position.size(), vec3(0, 0, 1));
  const BuiltMesh built = build(p);
  EXPECT_EQ(built.report.turned_parts, 1u);
  for (std::uint32_t v = 0; v < built.mesh.vertex_count; ++v) EXPECT_EQ(built.mesh.normal(v), vec3(0, 0, 1));
  expect_drawn_as_touched(built);
  for (std::size_t v = 0; v < p.normal.size(); ++v)
    if (p.position[v].x < 0.3f) p.normal[v] = vec3(0, 0, -1);
  const BuiltMesh torn = build(p);
  EXPECT_EQ(torn.report.turned_parts, 0u);
  EXPECT_EQ(torn.report.undecided_parts, 1u);
}

TEST(MeshWinding, SpawnSaysOnceWhatWasTurnedAndLeavesWhatIsOnlyDrawn) {
  Level level = level_of(inside_out(box({1, 1, 1}, false)));
  level.nodes.push_back(level.nodes[0]);
  level.nodes[1].name = "larger";
  level.nodes[1].local.scale = vec3(2);
  std::vector<std::string> notes;
  ASSERT_TRUE(spawn(level, &notes).ok());
  EXPECT_EQ(std::count_if(notes.begin(), notes.end(),
                          [](const std::string& note) {
                            return note ==
                                   "mesh `mesh`: 1 part that was inside out is turned over; `pliant convert --reorder` "
                                   "writes it mended";
                          }),
            1);
  level.nodes.resize(1);
  level.nodes[0].deformable.reset();
  notes.clear();
  const Result<World> room = spawn(level, &notes);
  ASSERT_TRUE(room.ok());
  EXPECT_TRUE(notes.empty());
  for (auto [entity, drawable] : room->registry.view<const Drawable>()) {
    const DrawMesh& draw = room->draw_meshes[drawable.mesh];
    const vec3 a = draw.vertices[draw.indices[0]].position, b = draw.vertices[draw.indices[1]].position,
               c = draw.vertices[draw.indices[2]].position;
    EXPECT_LT(dot(cross(b - a, c - a), a + b + c), 0.0f) << "a room is seen from within";
  }
}

TEST(MeshWinding, ValidateNamesWhatWasTurnedAndWhatCouldNotBeDecided) {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "pliant_winding_test.glb";
  const auto messages = [&](const Primitive& p) {
    EXPECT_TRUE(save_level(level_of(p), file).ok());
    std::string all;
    for (const Finding& finding : validate_level(file)) all += finding.message() + "\n";
    return all;
  };
  EXPECT_THAT(messages(inside_out(icosphere(2))), testing::HasSubstr("1 part that was inside out is turned over"));
  EXPECT_THAT(messages(joined({icosphere(3), inside_out(placed(icosphere(2), 0.6f, {0.9f, 0.05f, 0.02f}))})),
              testing::HasSubstr("1 part may be inside out"));
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace pliant
