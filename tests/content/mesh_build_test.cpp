#include "content/mesh/mesh_build.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "content/mesh/hilbert.h"
#include "runtime/hash.h"
#include "runtime/parallel.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using test::build;
using test::enclosed_volume;
using test::icosphere;
using test::sheet;
using test::unshared;

double net_area(const Mesh& mesh) {
  double sum = 0.0;
  for (const uvec3& t : mesh.triangles) {
    const dvec3 a(mesh.position(t.x)), b(mesh.position(t.y)), c(mesh.position(t.z));
    sum += 0.5 * length(cross(b - a, c - a));
  }
  return sum;
}

template <class T>
void add(Hash& hash, const std::vector<T>& values) {
  hash.add_bytes(values.data(), values.size() * sizeof(T));
}

std::uint64_t hash_of(const BuiltMesh& built) {
  const Mesh& m = built.mesh;
  Hash hash;
  for (const auto* v : {&m.px, &m.py, &m.pz, &m.nx, &m.ny, &m.nz, &m.area, &m.stiffness_factor, &m.friction_factor})
    add(hash, *v);
  add(hash, m.triangles);
  add(hash, m.across);
  for (const auto& level : m.tree.levels) add(hash, level);
  for (const TreeNode& node : m.tree.nodes) {
    hash.add_bytes(node.low, sizeof node.low);
    hash.add_bytes(node.high, sizeof node.high);
    hash.add_bytes(node.first, sizeof node.first);
    hash.add_bytes(node.count, sizeof node.count);
  }
  add(hash, m.zone_box);
  add(hash, m.zone_neighbour_first);
  add(hash, m.zone_neighbours);
  for (const DrawVertex& v : built.draw.vertices) hash.add_bytes(&v, sizeof v);
  add(hash, built.draw.indices);
  return hash.value();
}

// Each edge, by its ordered ends, with the triangles that traverse it in that direction.
std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edge_map(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) edges[{mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]}].push_back(t);
  return edges;
}

void expect_adjacency_of_naive_map(const Mesh& mesh, const MeshReport& report) {
  const auto edges = edge_map(mesh);
  const auto runs = [&](std::uint32_t a, std::uint32_t b) {
    const auto e = edges.find({a, b});
    return e == edges.end() ? std::vector<std::uint32_t>{} : e->second;
  };
  std::set<std::pair<std::uint32_t, std::uint32_t>> border, non_manifold;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3];
      const auto same = runs(a, b), opposite = runs(b, a);
      const bool manifold = same.size() == 1 && opposite.size() == 1;
      ASSERT_EQ(mesh.across[t][i], manifold ? opposite[0] : kBorder) << "triangle " << t << " edge " << i;
      if (same.size() + opposite.size() == 1) border.insert(std::minmax(a, b));
      if (same.size() + opposite.size() > 1 && !manifold) non_manifold.insert(std::minmax(a, b));
    }
  EXPECT_EQ(report.border_edges, border.size());
  EXPECT_EQ(report.non_manifold_edges, non_manifold.size());
  EXPECT_EQ(mesh.closed, border.empty() && non_manifold.empty());
}

TEST(MeshBuild, UnsharedSphereWeldsToTheEulerCountAndIsClosed) {
  const Primitive sphere = icosphere(3);
  const BuiltMesh built = build(unshared(sphere));
  EXPECT_EQ(built.mesh.triangles.size(), 20u * 64u);
  EXPECT_EQ(built.mesh.vertex_count, built.mesh.triangles.size() / 2 + 2);  // V - E + F = 2 with E = 3F/2
  EXPECT_EQ(built.report.welded_vertices, 3 * built.mesh.triangles.size() - built.mesh.vertex_count);
  EXPECT_EQ(built.report.degenerate_triangles + built.report.duplicate_triangles, 0u);
  EXPECT_TRUE(built.mesh.closed);
}

// A sphere by angles whose sines are rounded: its seam and its lower pole have copies that differ in the last digits.
Primitive rounded_sphere(std::uint32_t rows) {
  Primitive out;
  const std::uint32_t columns = 2 * rows;
  for (std::uint32_t j = 0; j <= rows; ++j)
    for (std::uint32_t i = 0; i <= columns; ++i) {
      const double down = std::numbers::pi * j / rows, around = 2 * std::numbers::pi * i / columns;
      out.position.push_back(
          0.05f * vec3(std::sin(down) * std::cos(around), std::cos(down), std::sin(down) * std::sin(around)));
    }
  for (std::uint32_t j = 0; j < rows; ++j)
    for (std::uint32_t i = 0; i < columns; ++i) {
      const std::uint32_t a = j * (columns + 1) + i, b = a + columns + 1;
      out.index.insert(out.index.end(), {a, a + 1, b, a + 1, b + 1, b});
    }
  return out;
}

TEST(MeshBuild, SeamsAndPolesThatDifferByRoundingAreClosed) {
  for (const std::uint32_t rows : {6u, 17u, 40u}) {
    const BuiltMesh built = build(rounded_sphere(rows));
    EXPECT_GT(built.report.joined_vertices, 0u) << rows;
    EXPECT_EQ(built.report.border_edges + built.report.non_manifold_edges, 0u) << rows;
    EXPECT_TRUE(built.mesh.closed) << rows;
    EXPECT_EQ(built.mesh.vertex_count, 2 * rows * (rows - 1) + 2) << rows;
  }
  Primitive two = sheet(3);  // a gap wider than rounding stays
  const std::size_t count = two.position.size(), indices = two.index.size();
  for (std::size_t v = 0; v < count; ++v) two.position.push_back(two.position[v] + vec3(0, 1e-5f, 0));
  for (std::size_t i = 0; i < indices; ++i) two.index.push_back(two.index[i] + static_cast<std::uint32_t>(count));
  EXPECT_EQ(build(two).report.joined_vertices, 0u);
}

TEST(MeshBuild, VertexAreasSumToTheTriangles) {
  for (const Primitive& p : {icosphere(4), sheet(17)}) {
    const Mesh mesh = build(p).mesh;
    double sum = 0.0;
    for (const float a : mesh.area) sum += static_cast<double>(a);
    EXPECT_NEAR(sum, net_area(mesh), 1e-6 * sum);
  }
}

// Exact within the rounding of vertices, which matters more for shorter edges.
TEST(MeshBuild, NormalsOfASphereAreItsRadiiHoweverItIsCut) {
  for (const int levels : {2, 3, 4}) {
    const Mesh mesh = build(icosphere(levels)).mesh;
    double worst = 0.0;
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
      worst = std::max(worst, std::acos(std::min(1.0, dot(dvec3(mesh.normal(v)), normalize(dvec3(mesh.position(v)))))));
    EXPECT_LT(worst, 1e-3) << levels;
  }
}

TEST(MeshBuild, NormalsAreWeightedByAngleSoThatACubeCornerPointsAlongItsDiagonalHoweverItsFacesAreSplit) {
  Primitive p;  // three faces meet at the origin; two triangles on one of them, one on each of the others
  p.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}};
  p.index = {0, 4, 1, 0, 2, 4, 0, 3, 2, 0, 1, 3};
  const Mesh mesh = build(p).mesh;
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v)
    if (mesh.position(v) == vec3(0)) {
      EXPECT_LT(length(mesh.normal(v) - normalize(vec3(-1, -1, -1))), 1e-6f);
    }
}

TEST(MeshBuild, DegenerateTrianglesAreDroppedAndCounted) {
  Primitive p = sheet(1);
  p.position.push_back({0.5f, 0.5f, 0.0f});  // on the diagonal: flat together with its ends
  p.uv.emplace_back(0.5f, 0.5f);
  for (const std::uint32_t v : {0u, 0u, 1u, 0u, 4u, 3u, 2u, 2u, 2u}) p.index.push_back(v);
  const BuiltMesh built = build(p);
  EXPECT_EQ(built.report.degenerate_triangles, 3u);
  EXPECT_EQ(built.mesh.triangles.size(), 2u);
  EXPECT_EQ(built.mesh.vertex_count, 4u);  // the one used only by a dropped triangle is removed
  EXPECT_EQ(built.draw.indices.size(), 6u);
}

TEST(MeshBuild, DuplicatesAreTouchedOnceWhateverTheirRotationAndAReversedOneIsStillDrawn) {
  Primitive p = sheet(1);
  p.index = {0, 1, 3, 1, 3, 0, 3, 1, 0, 0, 3, 2, 1, 0, 3};
  const BuiltMesh built = build(p);
  EXPECT_EQ(built.report.duplicate_triangles, 3u);
  EXPECT_EQ(built.mesh.triangles.size(), 2u);
  EXPECT_EQ(built.draw.indices.size(), 9u);
  for (std::uint32_t v = 0; v < built.mesh.vertex_count; ++v) EXPECT_EQ(built.mesh.normal(v), vec3(0, 0, 1));
  EXPECT_EQ(built.report.non_manifold_edges, 0u);
}

// A box from low to high; `inward`: a cavity.
void add_box(Primitive& p, vec3 low, vec3 high, bool inward = false) {
  const auto first = static_cast<std::uint32_t>(p.position.size());
  for (int i = 0; i < 8; ++i)
    p.position.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  for (const uvec3 t : {uvec3(0, 4, 6),
                        {0, 6, 2},
                        {1, 7, 5},
                        {1, 3, 7},
                        {0, 1, 5},
                        {0, 5, 4},
                        {2, 6, 7},
                        {2, 7, 3},
                        {0, 2, 3},
                        {0, 3, 1},
                        {4, 7, 6},
                        {4, 5, 7}})
    for (const std::uint32_t v : {t.x, inward ? t.z : t.y, inward ? t.y : t.z}) p.index.push_back(first + v);
}

TEST(MeshBuild, WallsAtWhichPartsAreFlushAreDroppedAndThePartsAreOneBody) {
  Primitive two;  // the walls at x = 1 have the same diagonal: 0 to 6 and 1 to 7
  add_box(two, {0, 0, 0}, {1, 1, 1});
  add_box(two, {1, 0, 0}, {3, 1, 1});
  const BuiltMesh built = build(two);
  EXPECT_EQ(built.report.flush_walls, 2u);
  EXPECT_EQ(built.report.duplicate_triangles, 0u);
  EXPECT_EQ(built.mesh.triangles.size(), 20u);
  EXPECT_TRUE(built.mesh.closed);
  EXPECT_NEAR(enclosed_volume(built.mesh), 3.0, 1e-6);
  EXPECT_EQ(built.draw.indices.size(), 60u);

  Primitive four;
  for (const float x : {0.0f, 1.0f})
    for (const float z : {0.0f, 1.0f}) add_box(four, {x, 0, z}, {x + 1, 1, z + 1});
  const BuiltMesh block = build(four);
  EXPECT_EQ(block.report.flush_walls, 8u);
  EXPECT_TRUE(block.mesh.closed);
  EXPECT_NEAR(enclosed_volume(block.mesh), 4.0, 1e-6);
}

TEST(MeshBuild, ASeptumAndATwoSidedSheetStay) {
  Primitive hollow;  // two cavities in a box, nothing between them but a septum
  add_box(hollow, {-1, -1, -1}, {3, 2, 2});
  add_box(hollow, {0, 0, 0}, {1, 1, 1}, true);
  add_box(hollow, {1, 0, 0}, {2, 1, 1}, true);
  EXPECT_EQ(build(hollow).report.flush_walls, 0u);
  EXPECT_EQ(build(hollow).report.duplicate_triangles, 2u);

  Primitive leaf = sheet(2);
  const std::vector<std::uint32_t> front = leaf.index;
  for (std::size_t i = 0; i < front.size(); i += 3)
    leaf.index.insert(leaf.index.end(), {front[i], front[i + 2], front[i + 1]});
  EXPECT_EQ(build(leaf).report.flush_walls, 0u);
  EXPECT_EQ(build(leaf).mesh.triangles.size(), 8u);
}

TEST(MeshBuild, MinusZeroAndZeroAreOnePosition) {
  Primitive p;
  p.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, -0.0f, 0}, {1, -0.0f, -0.0f}, {0, -1, 0}};
  p.index = {0, 1, 2, 4, 3, 5};
  const BuiltMesh built = build(p);
  EXPECT_EQ(built.mesh.vertex_count, 4u);
  EXPECT_EQ(built.report.border_edges, 4u);
}

TEST(MeshBuild, AdjacencyEqualsANaiveMapOnClosedOpenAndBrokenSurfaces) {
  Primitive fan = sheet(6);  // a third triangle on an inner edge, a reversed triangle, and one attached at a corner
  fan.position.insert(fan.position.end(), {{0.5f, 0.5f, 1.0f}, {2, 2, 2}, {3, 2, 2}});
  fan.uv.resize(fan.position.size());
  for (const std::uint32_t v : {10u, 11u, 49u, 0u, 50u, 51u}) fan.index.push_back(v);
  std::swap(fan.index[30], fan.index[31]);
  for (const Primitive& p : {unshared(icosphere(3)), sheet(9), fan}) {
    const BuiltMesh built = build(p);
    expect_adjacency_of_naive_map(built.mesh, built.report);
  }
}

TEST(MeshBuild, RandomTriangleSoupKeepsTheAdjacencyOfANaiveMap) {
  std::mt19937 random(7);
  Primitive p;
  for (int i = 0; i < 40; ++i) p.position.emplace_back(random() % 8, random() % 8, random() % 8);
  for (int i = 0; i < 600; ++i) p.index.push_back(static_cast<std::uint32_t>(random() % 40));
  const BuiltMesh built = build(p);
  expect_adjacency_of_naive_map(built.mesh, built.report);
  std::set<std::array<std::uint32_t, 3>> seen;
  for (const uvec3& t : built.mesh.triangles) {
    std::array<std::uint32_t, 3> corners{t.x, t.y, t.z};
    std::sort(corners.begin(), corners.end());
    EXPECT_TRUE(seen.insert(corners).second) << "the same three corners twice";
    EXPECT_TRUE(corners[0] < corners[1] && corners[1] < corners[2]);
  }
}

TEST(MeshBuild, AMirroringFrameKeepsTheSurfaceOutward) {
  for (const vec3& scale : {vec3(1, 1, 1), vec3(-1, 1, 1), vec3(2, -0.5f, 1), vec3(-1, -1, -3)}) {
    mat4 frame(1.0f);
    for (int i = 0; i < 3; ++i) frame[i] *= scale[i];
    Primitive p = icosphere(2);
    p.normal = p.position;
    const BuiltMesh built = build(p, frame);
    EXPECT_GT(enclosed_volume(built.mesh), 0.0);
    for (std::uint32_t v = 0; v < built.mesh.vertex_count; ++v)
      EXPECT_GT(dot(built.mesh.normal(v), built.mesh.position(v)), 0.0f);
    for (const DrawVertex& v : built.draw.vertices) {
      const vec3 exact = normalize(v.position / (scale * scale));  // gradient of the ellipsoid
      EXPECT_LT(length(v.normal - exact), 1e-5f);
    }
  }
}

TEST(MeshBuild, DrawVerticesSplitAtATextureSeamAndNowhereElse) {
  Primitive left = sheet(4), right = sheet(4);
  for (vec3& p : right.position) p.x += 1.0f;
  left.material = 1;
  right.material = 0;
  const std::vector<Primitive> both{left, right};
  Result<BuiltMesh> built = build_mesh("two", both, mat4(1.0f));
  ASSERT_TRUE(built.ok());
  EXPECT_EQ(built->mesh.vertex_count, 5u * 9u);
  EXPECT_EQ(built->draw.vertices.size(), 2u * 25u);  // the shared column has uv.x = 1 on one side, 0 on the other
  ASSERT_EQ(built->draw.parts.size(), 2u);
  EXPECT_EQ(built->draw.parts[0].material, 0);
  EXPECT_EQ(built->draw.parts[1].material, 1);
  for (const DrawPart& part : built->draw.parts) {
    EXPECT_EQ(part.index_count, 3u * 32u);
    for (std::uint32_t i = 0; i < part.index_count; i += 3) {
      const DrawVertex& v = built->draw.vertices[built->draw.indices[part.first_index + i]];
      EXPECT_EQ(v.position, built->mesh.position(v.touch_vertex));
      EXPECT_NEAR(v.uv.x, v.position.x - (part.material == 0 ? 1.0f : 0.0f), 1e-6f);
    }
  }
}

TEST(MeshBuild, TangentsFollowGrowingUAndMirroredTextureTurnsTheBitangentOver) {
  Primitive p = sheet(4);
  for (vec2& uv : p.uv) uv = vec2(std::abs(uv.x - 0.5f), uv.y);  // mirrored about x = 0.5
  const BuiltMesh built = build(p);
  EXPECT_TRUE(built.report.made_tangents);
  EXPECT_EQ(built.mesh.vertex_count, 25u);
  EXPECT_EQ(built.draw.vertices.size(), 30u);  // the middle column is on both sides of the mirror
  for (std::size_t i = 0; i < built.draw.indices.size(); i += 3) {
    float x = 0.0f;
    for (std::size_t k = 0; k < 3; ++k) x += built.draw.vertices[built.draw.indices[i + k]].position.x / 3.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      const DrawVertex& v = built.draw.vertices[built.draw.indices[i + k]];
      const float side = x > 0.5f ? 1.0f : -1.0f;
      EXPECT_LT(length(vec3(v.tangent) - vec3(side, 0, 0)), 1e-6f);
      const vec3 bitangent = cross(v.normal, vec3(v.tangent)) * v.tangent.w;
      EXPECT_LT(length(bitangent - vec3(0, 1, 0)), 1e-6f);
    }
  }
}

TEST(MeshBuild, PaintedFactorsAreTheMeanOfWeldedCopies) {
  Primitive a = sheet(1), b = sheet(1);
  for (vec3& p : b.position) p.x += 1.0f;
  a.stiffness.assign(4, 2.0f);
  b.stiffness.assign(4, 4.0f);
  const std::vector<Primitive> both{a, b};
  Result<BuiltMesh> built = build_mesh("two", both, mat4(1.0f));
  ASSERT_TRUE(built.ok());
  for (std::uint32_t v = 0; v < built->mesh.vertex_count; ++v)
    EXPECT_EQ(built->mesh.stiffness_factor[v], 2.0f + built->mesh.px[v]);
  EXPECT_TRUE(built->mesh.friction_factor.empty());
}

TEST(MeshBuild, RefusesWhatIsNoSurfaceWithOneSentence) {
  Primitive p = sheet(1);
  Primitive nan = p, far = p, empty, flat = p, bad_index = p, negative = p;
  nan.position[2].y = std::numeric_limits<float>::quiet_NaN();
  far.position[0].x = 1e30f;
  flat.index = {0, 0, 1};
  bad_index.index[0] = 4;
  negative.stiffness.assign(4, -1.0f);
  for (const Primitive& bad : {nan, far, empty, flat, bad_index, negative}) {
    Result<BuiltMesh> built = build_mesh("bad", {&bad, 1}, mat4(1.0f));
    ASSERT_FALSE(built.ok());
    EXPECT_THAT(built.error().message(), testing::HasSubstr("mesh `bad`: "));
    EXPECT_NE(built.error().cure, "");
  }
}

TEST(MeshBuild, ResultHasTheSameBitsOnAnyNumberOfThreads) {
  Primitive p = unshared(icosphere(5));
  p.uv.resize(p.position.size());
  for (std::size_t i = 0; i < p.uv.size(); ++i) p.uv[i] = vec2(p.position[i]);
  p.stiffness.assign(p.position.size(), 1.5f);
  set_thread_count(1);
  const std::uint64_t alone = hash_of(build(p));
  for (const unsigned threads : {2u, 4u}) {
    set_thread_count(threads);
    EXPECT_EQ(hash_of(build(p)), alone) << threads;
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace pliant
