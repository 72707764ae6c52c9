// Coarse touch meshes, refined along the curved surface that is used for touch.
#include "content/mesh/mesh_finer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using test::box;
using test::cylinder;
using test::enclosed_volume;
using test::globe;
using test::icosphere;
using test::level_of;
using test::sheet;
using test::worst_gap;

BuiltMesh build(const std::vector<Primitive>& primitives, std::optional<DentSize> dents,
                const mat4& to_object = mat4(1.0f)) {
  MeshOptions options;
  options.dents = dents;
  Result<BuiltMesh> built = build_mesh("test", primitives, to_object, options);
  EXPECT_TRUE(built.ok()) << built.error().message();
  return std::move(*built);
}

double longest_edge(const Mesh& mesh) {
  double longest = 0.0;
  for (const uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      longest = std::max(longest, length(dvec3(mesh.position(t[(i + 1) % 3])) - dvec3(mesh.position(t[i]))));
  return longest;
}

// [m] of all creases.
double crease_length(const Mesh& mesh) {
  double sum = 0.0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      if (mesh.is_crease(t, i))
        sum +=
            length(dvec3(mesh.position(mesh.triangles[t][(i + 1) % 3])) - dvec3(mesh.position(mesh.triangles[t][i])));
  return sum / 2.0;
}

void expect_drawn_where_touched(const BuiltMesh& built) {
  EXPECT_EQ(built.draw.indices.size(), 3 * built.mesh.triangles.size());
  for (const DrawVertex& v : built.draw.vertices) ASSERT_EQ(v.position, built.mesh.position(v.touch_vertex));
}

TEST(MeshFiner, ABoxKeepsItsFacesItsCreasesAndItsVolume) {
  for (const bool normals : {false, true}) {
    const BuiltMesh built = build({box({0.5f, 0.4f, 0.3f}, normals)}, DentSize{0.25});
    const Mesh& mesh = built.mesh;
    EXPECT_EQ(built.report.refined_from, 12u);
    EXPECT_GT(mesh.triangles.size(), 1000u);
    EXPECT_LE(longest_edge(mesh), 0.25 / 3);
    EXPECT_TRUE(mesh.closed) << "something opened";
    EXPECT_NEAR(enclosed_volume(mesh), 0.48, 1e-6);
    EXPECT_NEAR(crease_length(mesh), 4 * (1.0 + 0.8 + 0.6), 1e-5);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const uvec3 c = mesh.triangles[t];
      const vec3 face =
          normalize(cross(mesh.position(c.y) - mesh.position(c.x), mesh.position(c.z) - mesh.position(c.x)));
      for (int i = 0; i < 3; ++i) ASSERT_LT(length(mesh.normal(t, i) - face), 1e-6f);
    }
    expect_drawn_where_touched(built);
    for (std::size_t i = 0; i < built.draw.indices.size(); ++i) {
      const vec3 n = built.draw.vertices[built.draw.indices[i]].normal;
      ASSERT_NEAR(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1.0f, 1e-6f) << "shaded over an edge";
    }
    EXPECT_LT(worst_gap(mesh), 1e-6);
  }
}

TEST(MeshFiner, ACoarseSmoothSphereBecomesItsPatches) {
  Primitive p = globe(6, 5);
  p.normal = p.position;
  const BuiltMesh coarse = build({p}, std::nullopt), finer = build({p}, DentSize{0.3});
  EXPECT_EQ(finer.report.refined_from, 48u);
  EXPECT_TRUE(finer.mesh.closed);
  EXPECT_TRUE(finer.mesh.crease.empty());
  EXPECT_TRUE(finer.mesh.split_normals.empty());
  EXPECT_LT(worst_gap(finer.mesh), 1e-6);
  // The patches' distance from the sphere: refinement must not increase it.
  const auto radii = [](const Mesh& mesh, int steps) {
    double low = 2.0, high = 0.0;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const CurvedPatch patch = curved_patch(mesh, t);
      for (int i = 0; i <= steps; ++i)
        for (int j = 0; i + j <= steps; ++j) {
          const double r = length(patch.at(double(i) / steps, double(j) / steps).p);
          low = std::min(low, r), high = std::max(high, r);
        }
    }
    return std::make_pair(low, high);
  };
  const auto before = radii(coarse.mesh, 16), after = radii(finer.mesh, 4);
  EXPECT_NEAR(after.first, before.first, 0.002);
  EXPECT_NEAR(after.second, before.second, 0.002);
  // The flat triangles now lie within a hundredth of the reach of the patches.
  for (const uvec3& t : finer.mesh.triangles) {
    const dvec3 centre =
        (dvec3(finer.mesh.position(t.x)) + dvec3(finer.mesh.position(t.y)) + dvec3(finer.mesh.position(t.z))) / 3.0;
    EXPECT_GT(length(centre), before.first - 0.006);
  }
  for (std::uint32_t v = 0; v < finer.mesh.vertex_count; ++v)
    EXPECT_GT(dot(finer.mesh.normal(v), normalize(finer.mesh.position(v))), std::cos(0.2f));
}

TEST(MeshFiner, ACylinderStaysCreasedAlongItsRimsAndGetsRounder) {
  for (const bool normals : {false, true}) {
    const BuiltMesh coarse = build({cylinder(12, normals)}, std::nullopt),
                    built = build({cylinder(12, normals)}, DentSize{0.3});
    EXPECT_TRUE(built.mesh.closed);
    EXPECT_GT(crease_length(built.mesh), crease_length(coarse.mesh)) << "the rim's chords become its arcs";
    EXPECT_NEAR(crease_length(built.mesh), 4 * std::numbers::pi, 0.02);
    EXPECT_LT(worst_gap(built.mesh), 1e-6);
    expect_drawn_where_touched(built);
    for (std::uint32_t t = 0; t < built.mesh.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) {
        const vec3 n = built.mesh.normal(t, i), p = built.mesh.position(built.mesh.triangles[t][i]);
        ASSERT_TRUE(std::abs(n.y) > 0.99f || dot(n, vec3(p.x, 0, p.z)) > 0.98f) << n.x << ' ' << n.y << ' ' << n.z;
      }
  }
}

TEST(MeshFiner, PrimitivesAreCutAlikeAndWhatIsLinearStaysLinear) {
  // The box's faces as separate primitives, painted and textured.
  const Primitive whole = box({1, 1, 1}, true);
  std::vector<Primitive> faces;
  for (std::uint32_t f = 0; f < 6; ++f) {
    Primitive p;
    p.material = static_cast<std::int32_t>(f % 3);
    for (std::uint32_t v = 4 * f; v < 4 * f + 4; ++v) {
      const vec3 x = whole.position[v];
      p.position.push_back(x);
      p.normal.push_back(whole.normal[v]);
      p.uv.emplace_back(x.x + 2 * x.y, x.z);
      p.stiffness.push_back(4 + x.x + x.y);
      p.damping.push_back(4 + x.z);
      p.relaxation.push_back(4 - x.y);
    }
    p.index = {0, 1, 2, 0, 2, 3};
    faces.push_back(p);
  }
  mat4 frame(1.0f);
  frame[0][0] = -3.0f;  // mirrors and stretches
  const BuiltMesh built = build(faces, DentSize{1.0}, frame);
  const Mesh& mesh = built.mesh;
  EXPECT_TRUE(mesh.closed);
  EXPECT_GT(enclosed_volume(mesh), 0.0);
  EXPECT_EQ(built.draw.parts.size(), 3u);
  EXPECT_LE(longest_edge(mesh), 1.0 / 3);
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const vec3 x = mesh.position(v) / vec3(-3, 1, 1);
    ASSERT_NEAR(mesh.stiffness_factor[v], 4 + x.x + x.y, 1e-5f);
    ASSERT_NEAR(mesh.damping_factor[v], 4 + x.z, 1e-5f);
    ASSERT_NEAR(mesh.relaxation_factor[v], 4 - x.y, 1e-5f);
  }
  for (const DrawVertex& v : built.draw.vertices) {
    const vec3 x = v.position / vec3(-3, 1, 1);
    ASSERT_LT(length(v.uv - vec2(x.x + 2 * x.y, x.z)), 1e-5f);
    ASSERT_NEAR(std::max({std::abs(v.normal.x), std::abs(v.normal.y), std::abs(v.normal.z)}), 1.0f, 1e-6f);
  }
}

TEST(MeshFiner, AFineMeshIsUntouchedToTheBit) {
  const Primitive p = icosphere(5);
  const BuiltMesh before = build({p}, std::nullopt), after = build({p}, DentSize{0.0});
  EXPECT_EQ(after.report.refined_from, 0u);
  EXPECT_EQ(after.mesh.px, before.mesh.px);
  EXPECT_EQ(after.mesh.ny, before.mesh.ny);
  EXPECT_EQ(after.mesh.triangles, before.mesh.triangles);
  EXPECT_EQ(after.mesh.across, before.mesh.across);
  EXPECT_EQ(after.draw.indices, before.draw.indices);
  ASSERT_EQ(after.draw.vertices.size(), before.draw.vertices.size());
  EXPECT_EQ(std::memcmp(after.draw.vertices.data(), before.draw.vertices.data(),
                        after.draw.vertices.size() * sizeof(DrawVertex)),
            0);
}

TEST(MeshFiner, WhatWasCutIsNotCoarseUnlessItWouldBecomeTooMuch) {
  EXPECT_FALSE(is_coarse(build({icosphere(1)}, DentSize{0.4}).mesh, 0.41));
  const BuiltMesh bounded = build({box({1, 1, 1}, false)}, DentSize{0.003});
  EXPECT_LE(bounded.mesh.triangles.size(), 12 + kMostAdded);
  EXPECT_GT(bounded.mesh.triangles.size(), kMostAdded / 8);
  EXPECT_TRUE(bounded.mesh.closed);
}

TEST(MeshFiner, AnOpenSheetStaysOpenAlongItsBorderAndItsBackIsDrawn) {
  Primitive p = sheet(2);
  const std::vector<std::uint32_t> front = p.index;
  for (std::size_t i = 0; i < front.size(); i += 3)
    p.index.insert(p.index.end(), {front[i], front[i + 2], front[i + 1]});
  const BuiltMesh built = build({p}, DentSize{0.3});
  EXPECT_FALSE(built.mesh.closed);
  EXPECT_EQ(built.draw.indices.size(), 6 * built.mesh.triangles.size());
  double area = 0.0;
  for (const float a : built.mesh.area) area += static_cast<double>(a);
  EXPECT_NEAR(area, 1.0, 1e-5);
  for (std::uint32_t v = 0; v < built.mesh.vertex_count; ++v) EXPECT_EQ(built.mesh.normal(v), vec3(0, 0, 1));
}

TEST(MeshFiner, SpawnRefinesWhatGivesWayAndSaysSo) {
  Level level = level_of(box({1, 1, 1}, false));
  level.nodes.push_back(level.nodes[0]);
  level.nodes[1].name = "rigid";
  level.nodes[1].deformable.reset();
  level.nodes[1].rigid_body = RigidBody{};
  level.nodes.push_back(level.nodes[0]);
  level.nodes[2].name = "same";
  level.nodes.push_back(level.nodes[0]);
  level.nodes[3].name = "wide";
  level.nodes[3].deformable->reach = 20.0;
  std::vector<std::string> notes;
  const Result<World> world = spawn(level, &notes);
  ASSERT_TRUE(world.ok()) << world.error().message();
  EXPECT_EQ(world->meshes.size(), 2u) << "as it is for the rigid body and the wide dent, finer for the others";
  for (auto [entity, deformable, name] : world->registry.view<const Deformable, const Name>()) {
    const Mesh& mesh = world->meshes[deformable.mesh];
    if (name.value == "wide")
      EXPECT_EQ(mesh.triangles.size(), 12u);
    else
      EXPECT_GT(mesh.triangles.size(), 1000u);
  }
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], testing::MatchesRegex("`thing`: 12 triangles refined to [0-9]+,[0-9]+ so that dents can show"));
}

TEST(MeshFiner, AContactRadiusAsksForEdgesOfHalfOfItWhereTheShapeDependsOnIt) {
  DeformableParameters d;
  d.reach = 0.3;
  d.contact_radius = 0.06;
  const auto longest = [](const DeformableParameters& of) {
    return longest_edge(build({box({1, 1, 1}, false)}, dent_size(of)).mesh);
  };
  d.shape = Shape::kVolume;
  EXPECT_LE(longest(d), 0.3 / 3);
  EXPECT_GT(longest(d), 0.3 / 6);
  d.shape = Shape::kPunch;
  EXPECT_LE(longest(d), 0.06 / 2);
  d.contact_radius = 0.0;
  EXPECT_GT(longest(d), 0.3 / 6) << "a fifth of the reach that nobody said asks for nothing";
}

TEST(MeshFiner, RealMeshesStayClosedAndSound) {
  namespace fs = std::filesystem;
  const fs::path corpus(PLIANT_CORPUS_DIR);
  if (!fs::exists(corpus)) GTEST_SKIP() << "the corpus is not beside this checkout: " << corpus;
  std::vector<fs::path> files{corpus / "meshes-draco/Box_Draco.glb"};
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(corpus / "meshes-valid"))
    if (file.path().extension() == ".glb" && fs::file_size(file.path()) < 3u << 20) files.push_back(file.path());
  for (const fs::path& file : files) {
    const Result<Level> level = load_level(file);
    ASSERT_TRUE(level.ok()) << level.error().message();
    for (const LevelMesh& mesh : level->meshes) {
      SCOPED_TRACE(file.filename().string() + ": " + mesh.name);
      const BuiltMesh before = build(mesh.primitives, std::nullopt), after = build(mesh.primitives, DentSize{0.0});
      EXPECT_EQ(after.mesh.closed, before.mesh.closed);
      EXPECT_EQ(after.mesh.crease.empty(), before.mesh.crease.empty());
      // Curves leave their chords by a share of an edge, and thin ligaments have little volume for their area.
      double area = 0.0;
      for (const float a : before.mesh.area) area += static_cast<double>(a);
      if (before.mesh.closed)
        EXPECT_NEAR(enclosed_volume(after.mesh), enclosed_volume(before.mesh),
                    0.2 * area * static_cast<double>(before.mesh.mean_edge));
      for (std::uint32_t v = 0; v < after.mesh.vertex_count; ++v)
        ASSERT_NEAR(length(after.mesh.normal(v)), 1.0f, 1e-5f);
    }
  }
}

}  // namespace
}  // namespace pliant
