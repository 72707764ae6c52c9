// Creases, the normals between them, and the resulting curved surface.
#include "content/mesh/mesh_crease.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "components/curved_patch.h"
#include "content/level_file.h"
#include "content/mesh/mesh_build.h"
#include "runtime/parallel.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using test::box;
using test::cylinder;
using test::globe;
using test::icosphere;
using test::level_of;
using test::unshared;
using test::worst_gap;

Mesh creased(const Primitive& p, double crease_angle = 0.0) {
  Result<BuiltMesh> built = build_mesh("test", {&p, 1}, mat4(1.0f), {crease_angle});
  EXPECT_TRUE(built.ok()) << built.error().message();
  return std::move(built->mesh);
}

dvec3 face_normal(const Mesh& mesh, std::uint32_t t) {
  const dvec3 a(mesh.position(mesh.triangles[t].x)), b(mesh.position(mesh.triangles[t].y)),
      c(mesh.position(mesh.triangles[t].z));
  return normalize(cross(b - a, c - a));
}

// Counts each crease once.
std::size_t creases(const Mesh& mesh) {
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) count += mesh.is_crease(t, i);
  return count / 2;
}

void expect_creases_on_both_sides(const Mesh& mesh) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t other = mesh.across[t][i];
      if (other == kBorder) {
        EXPECT_FALSE(mesh.is_crease(t, i));
        continue;
      }
      for (int k = 0; k < 3; ++k)
        if (mesh.across[other][k] == t && mesh.triangles[other][k] == mesh.triangles[t][(i + 1) % 3]) {
          EXPECT_EQ(mesh.is_crease(t, i), mesh.is_crease(other, k));
        }
    }
}

TEST(MeshCrease, ABoxHasTwelveCreasesAndTheNormalsOfItsFacesWithAndWithoutNormalsInTheFile) {
  for (const bool normals : {false, true}) {
    const Mesh mesh = creased(box({0.3f, 0.2f, 0.5f}, normals));
    ASSERT_EQ(mesh.triangles.size(), 12u);
    ASSERT_EQ(mesh.vertex_count, 8u);
    EXPECT_EQ(creases(mesh), 12u);
    expect_creases_on_both_sides(mesh);
    for (std::uint32_t t = 0; t < 12; ++t) {
      for (int i = 0; i < 3; ++i) EXPECT_EQ(mesh.normal(t, i), vec3(face_normal(mesh, t)));
      EXPECT_TRUE(curved_patch(mesh, t).flat);
    }
  }
}

TEST(MeshCrease, ABoxIsDrawnWithTheNormalsItIsTouchedWith) {
  const Primitive p = box({1, 1, 1}, false);
  const Result<BuiltMesh> built = build_mesh("box", {&p, 1}, mat4(1.0f));
  ASSERT_TRUE(built.ok());
  for (std::size_t i = 0; i < built->draw.indices.size(); i += 3) {
    const DrawVertex* v[3];
    for (std::size_t k = 0; k < 3; ++k) v[k] = &built->draw.vertices[built->draw.indices[i + k]];
    const vec3 face = normalize(cross(v[1]->position - v[0]->position, v[2]->position - v[0]->position));
    for (const DrawVertex* each : v) {
      EXPECT_EQ(each->normal, face);
      EXPECT_NEAR(dot(each->normal, vec3(each->tangent)), 0.0f, 1e-6f);
    }
  }
}

TEST(MeshCrease, ACylinderIsCreasedAlongItsRimsAndSmoothAround) {
  for (const std::uint32_t n : {12u, 32u})
    for (const bool normals : {false, true}) {
      const Mesh mesh = creased(cylinder(n, normals));
      EXPECT_EQ(creases(mesh), 2 * n);
      expect_creases_on_both_sides(mesh);
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const dvec3 face = face_normal(mesh, t);
        for (int i = 0; i < 3; ++i) {
          const dvec3 p(mesh.position(mesh.triangles[t][i]));
          const dvec3 exact = std::abs(face.y) > 0.5 ? dvec3(0, face.y, 0) : dvec3(p.x, 0, p.z);
          EXPECT_LT(length(dvec3(mesh.normal(t, i)) - exact), 0.07) << "the side's triangles are not one each";
        }
      }
      EXPECT_LT(worst_gap(mesh), 1e-6);
    }
}

TEST(MeshCrease, ACoarseSphereIsSmoothWithTheFilesNormalsAndCreasedWithoutWhereItTurnsByMoreThanFortyDegrees) {
  Primitive p = globe(6, 5);
  ASSERT_EQ(p.index.size() / 3, 48u);
  const Mesh bare = creased(p);
  EXPECT_TRUE(bare.closed);
  for (std::uint32_t t = 0; t < bare.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(bare.is_crease(t, i),
                std::acos(std::min(1.0, dot(face_normal(bare, t), face_normal(bare, bare.across[t][i])))) > 0.7);
  EXPECT_GT(creases(bare), 0u);
  EXPECT_LT(worst_gap(bare), 1e-6);
  p.normal = p.position;
  const Mesh smooth = creased(p);
  EXPECT_TRUE(smooth.crease.empty());
  EXPECT_TRUE(smooth.split_normals.empty());
  EXPECT_TRUE(smooth.corner_normal.empty());
  EXPECT_LT(worst_gap(smooth), 1e-6);
}

// Two sheets that meet at an angle along the Z axis.
Primitive fold(double turn, bool ridge, bool smooth_normals) {
  Primitive p;
  const double slope = (ridge ? -0.5 : 0.5) * turn;
  const float x = float(std::cos(slope)), y = float(std::sin(slope));
  const vec3 left = normalize(vec3(y, x, 0)), right = normalize(vec3(-y, x, 0));
  const auto add = [&](vec3 position, vec3 normal) {
    p.index.push_back(static_cast<std::uint32_t>(p.position.size()));
    p.position.push_back(position);
    p.normal.push_back(smooth_normals && position.x == 0.0f ? vec3(0, 1, 0) : normal);
  };
  for (const vec3& q : {vec3(-x, y, 0), vec3(-x, y, 1), vec3(0, 0, 1), vec3(-x, y, 0), vec3(0, 0, 1), vec3(0, 0, 0)})
    add(q, left);
  for (const vec3& q : {vec3(0, 0, 0), vec3(0, 0, 1), vec3(x, y, 1), vec3(0, 0, 0), vec3(x, y, 1), vec3(x, y, 0)})
    add(q, right);
  return p;
}

TEST(MeshCrease, AFoldIsACreaseByItsTurnAndInBetweenByTheFilesNormals) {
  for (const bool ridge : {false, true}) {
    const auto count = [&](double degrees, bool smooth, bool file = true, double authored = 0.0) {
      Primitive p = fold(glm::radians(degrees), ridge, smooth);
      if (!file) p.normal.clear();
      const Mesh mesh = creased(p, authored);
      EXPECT_LT(worst_gap(mesh), 1e-6);
      return creases(mesh);
    };
    EXPECT_EQ(count(14, false), 0u);
    EXPECT_EQ(count(16, false), 1u);
    EXPECT_EQ(count(60, true), 0u);
    EXPECT_EQ(count(74, true), 0u);
    EXPECT_EQ(count(76, true), 1u);
    EXPECT_EQ(count(39, true, false), 0u);
    EXPECT_EQ(count(41, true, false), 1u);
    EXPECT_EQ(count(10, true, true, 0.1), 1u) << "an authored angle decides alone";
    EXPECT_EQ(count(80, false, true, 2.0), 0u) << "an authored angle decides alone";
  }
}

TEST(MeshCrease, ACreaseThatEndsWithinTheSurfaceLeavesNoCrack) {
  // A disc of eight sectors, two of which are raised: creases along their outer sides, flat elsewhere.
  Primitive p;
  p.position.emplace_back(0, 0, 0);
  for (int i = 0; i < 8; ++i) {
    const double a = std::numbers::pi * i / 4;
    p.position.emplace_back(std::cos(a), i == 1 ? 0.8 : 0.0, -std::sin(a));
  }
  for (std::uint32_t i = 0; i < 8; ++i)
    for (const std::uint32_t v : {0u, 1 + i, 1 + (i + 1) % 8}) p.index.push_back(v);
  const Mesh mesh = creased(p);
  EXPECT_GT(creases(mesh), 0u);
  EXPECT_LT(worst_gap(mesh), 1e-6);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(length(mesh.normal(t, i)), 1.0f, 1e-6f);
}

TEST(MeshCrease, NodesShareAMeshOnlyWhereTheirCreaseAnglesAgree) {
  Level level = level_of(box({1, 1, 1}, false));
  level.nodes.push_back(level.nodes[0]);
  level.nodes.push_back(level.nodes[0]);
  level.nodes[1].name = "same", level.nodes[2].name = "smooth";
  level.nodes[2].deformable->crease_angle = 3.0;
  const Result<World> world = spawn(level);
  ASSERT_TRUE(world.ok()) << world.error().message();
  ASSERT_EQ(world->meshes.size(), 2u);
}

TEST(MeshCrease, AreTheSameOnAnyNumberOfThreads) {
  const Primitive p = unshared(icosphere(5));
  set_thread_count(1);
  const Mesh one = creased(p, 0.02);
  set_thread_count(4);
  const Mesh four = creased(p, 0.02);
  set_thread_count(0);
  EXPECT_FALSE(one.crease.empty());
  EXPECT_EQ(one.crease, four.crease);
  EXPECT_EQ(one.split_normals, four.split_normals);
  EXPECT_EQ(one.corner_normal, four.corner_normal);
}

TEST(MeshCrease, TheCorpusBoxIsCreasedAndPatchesOfRealMeshesNeverPart) {
  namespace fs = std::filesystem;
  const fs::path corpus(PLIANT_CORPUS_DIR);
  if (!fs::exists(corpus)) GTEST_SKIP() << "the corpus is not beside this checkout: " << corpus;
  const Result<Level> box = load_level(corpus / "meshes-draco/Box_Draco.glb");
  ASSERT_TRUE(box.ok()) << box.error().message();
  const Result<BuiltMesh> built = build_mesh("box", box->meshes.at(0).primitives, mat4(1.0f));
  ASSERT_TRUE(built.ok());
  EXPECT_EQ(creases(built->mesh), 12u);
  for (const fs::directory_entry& file : fs::recursive_directory_iterator(corpus / "meshes-valid")) {
    if (file.path().extension() != ".glb" || fs::file_size(file.path()) > 3u << 20) continue;
    const Result<Level> level = load_level(file.path());
    ASSERT_TRUE(level.ok()) << level.error().message();
    for (const LevelMesh& mesh : level->meshes) {
      SCOPED_TRACE(file.path().filename().string() + ": " + mesh.name);
      const Result<BuiltMesh> each = build_mesh(mesh.name, mesh.primitives, mat4(1.0f));
      ASSERT_TRUE(each.ok()) << each.error().message();
      expect_creases_on_both_sides(each->mesh);
      EXPECT_LT(worst_gap(each->mesh), 1e-6);
    }
  }
}

}  // namespace
}  // namespace pliant
