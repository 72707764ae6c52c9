// Lattices of tetrahedra: against the volume they fill, the bounds that Labelle and Shewchuk prove, and the identities
// of a conforming mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <random>

#include "content/level/spawn_soft.h"
#include "content/mesh/mesh_build.h"
#include "content/tets/lattice.h"
#include "content/tets/lattice_inside.h"
#include "content/tets/tet_boundary.h"
#include "content/tets/tet_parts.h"
#include "content/tets/tet_quality.h"
#include "runtime/hash.h"
#include "runtime/parallel.h"
#include "tests/content/mesh_shapes.h"

namespace pliant {
namespace {

using test::enclosed_volume;
using test::icosphere;
using test::sheet;

constexpr double kDegree = std::numbers::pi / 180.0;

Mesh mesh_of(const std::vector<Primitive>& primitives, const mat4& to_object = mat4(1.0f)) {
  Result<BuiltMesh> built = build_mesh("test", primitives, to_object);
  EXPECT_TRUE(built.ok()) << built.error().message();
  return std::move(built->mesh);
}

// A torus about +Z that faces outward, without a symmetry that favours the lattice.
Primitive torus(float ring, float tube, std::uint32_t around, std::uint32_t along) {
  Primitive p;
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < along; ++j) {
      const double u = 2.0 * std::numbers::pi * i / around, v = 2.0 * std::numbers::pi * j / along;
      const double r = double(ring) + double(tube) * std::cos(v);
      p.position.emplace_back(vec3(dvec3(r * std::cos(u), r * std::sin(u), double(tube) * std::sin(v))));
    }
  for (std::uint32_t i = 0; i < around; ++i)
    for (std::uint32_t j = 0; j < along; ++j) {
      const std::uint32_t a = i * along + j, b = (i + 1) % around * along + j, c = i * along + (j + 1) % along,
                          d = (i + 1) % around * along + (j + 1) % along;
      for (const std::uint32_t v : {a, b, d, a, d, c}) p.index.push_back(v);
    }
  return p;
}

TetMesh lattice(const Mesh& surface, double cell = 0.0) {
  Result<TetMesh> mesh = make_lattice(surface, cell);
  EXPECT_TRUE(mesh.ok()) << mesh.error().message();
  return mesh ? std::move(*mesh) : TetMesh{};
}

void expect_conforming(const TetMesh& mesh) {
  for (const Tet& t : mesh.tets) ASSERT_GT(tet_volume(mesh.nodes, t), 0.0);
  // Overlapping elements would add up to more than their boundary encloses.
  double within = 0.0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const uvec3& t : boundary_triangles(mesh.tets)) {
    within += dot(mesh.nodes[t.x], cross(mesh.nodes[t.y], mesh.nodes[t.z])) / 6.0;
    for (int i = 0; i < 3; ++i) {
      ++edges[{t[i], t[(i + 1) % 3]}];
      --edges[{t[(i + 1) % 3], t[i]}];
    }
  }
  const double volume = total_volume(mesh);
  EXPECT_NEAR(within, volume, 1e-12 * volume);
  for (const auto& [edge, balance] : edges) ASSERT_EQ(balance, 0) << "the boundary is not closed";
  std::vector<int> uses(mesh.nodes.size(), 0);
  for (const Tet& t : mesh.tets)
    for (const std::uint32_t corner : t) ++uses[corner];
  EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 0);
  EXPECT_EQ(mesh.free_count, mesh.node_count());
}
void expect_sound(const TetMesh& mesh) {
  expect_conforming(mesh);
  EXPECT_GT(mesh.quality.smallest_dihedral, 10.78 * kDegree);
  EXPECT_LT(mesh.quality.largest_dihedral, 164.74 * kDegree);
}

TEST(Lattice, VolumeConvergesWithTheSquareOfTheCellAndElementsStayWellShaped) {
  for (const Primitive& shape : {icosphere(4), torus(1.0f, 0.4f, 64, 32)}) {
    const Mesh surface = mesh_of({shape});
    const double exact = enclosed_volume(surface);
    double error = 0.0;
    for (const double cell : {0.4, 0.2, 0.1}) {
      const TetMesh mesh = lattice(surface, cell);
      expect_sound(mesh);
      const double now = std::abs(total_volume(mesh) / exact - 1.0);
      if (error > 0.0) EXPECT_LT(now, 0.35 * error) << "at a cell of " << cell;
      error = now;
    }
    EXPECT_LT(error, 0.01);
  }
}

TEST(Lattice, ElementsInsideAreTheLatticesOwn) {
  // 60 and 90 degrees; 3 r/R of a body-centred cubic tetrahedron is 3 (a/(4 sqrt 2)) / (a sqrt 5/4) = 3/sqrt 10.
  const TetMesh mesh = lattice(mesh_of({icosphere(3)}), 0.15);
  EXPECT_NEAR(mesh.quality.median_ratio, 3.0 / std::sqrt(10.0), 1e-9);
}

TEST(Lattice, WithoutACellThereAreAboutTwoThousandTetrahedraWhateverTheScaleAndShape) {
  const std::vector<std::pair<Primitive, mat4>> shapes{{icosphere(3), mat4(1.0f)},
                                                       {icosphere(3), mat4(mat3(0.01f))},
                                                       {icosphere(3), mat4(mat3(1.0f, 0, 0, 0, 10.0f, 0, 0, 0, 0.5f))},
                                                       {torus(1.0f, 0.1f, 64, 16), mat4(1.0f)}};
  for (const auto& [shape, to_object] : shapes) {
    const TetMesh mesh = lattice(mesh_of({shape}, to_object));
    EXPECT_GT(mesh.tets.size(), 1600u);
    EXPECT_LT(mesh.tets.size(), 2400u);
    expect_sound(mesh);
  }
}

TEST(Lattice, EveryVertexOfTheSkinRidesWhereItStandsAndFollowsAffineMapsExactly) {
  for (const Primitive& shape : {icosphere(4), torus(1.0f, 0.15f, 64, 24)}) {
    const Mesh surface = mesh_of({shape});
    const TetMesh mesh = lattice(surface, 0.21);
    ASSERT_EQ(mesh.embedding.size(), surface.vertex_count);
    const dmat3 stretch(1.3, 0.2, -0.1, 0.4, 0.7, 0.0, 0.1, -0.3, 1.1);
    const dvec3 shift(3, -2, 5);
    for (std::uint32_t v = 0; v < surface.vertex_count; ++v) {
      const Embedding& e = mesh.embedding[v];
      dvec3 at(0), moved(0);
      double sum = 0.0;
      for (std::size_t i = 0; i < 4; ++i) {
        const dvec3 node = mesh.nodes[mesh.tets[e.tet][i]];
        at += e.weight[i] * node;
        moved += e.weight[i] * (stretch * node + shift);
        sum += e.weight[i];
        EXPECT_GT(e.weight[i], -1.0) << "thrown far outside its element";
      }
      const dvec3 p(surface.position(v));
      EXPECT_NEAR(sum, 1.0, 1e-14);
      EXPECT_LT(length(at - p), 1e-13 * double(surface.box.diagonal()));
      EXPECT_LT(length(moved - (stretch * p + shift)), 1e-12 * double(surface.box.diagonal()));
    }
  }
}

TEST(Lattice, ASmallHoleOrATurnedSurfaceChangesLittle) {
  const Primitive whole = icosphere(4);
  const double full = total_volume(lattice(mesh_of({whole}), 0.15));
  Primitive holed = whole;
  holed.index.resize(holed.index.size() - 3 * 40);
  const TetMesh mesh = lattice(mesh_of({holed}), 0.15);
  expect_sound(mesh);
  EXPECT_NEAR(total_volume(mesh), full, 0.01 * full);

  Primitive turned = whole;
  for (std::size_t i = 0; i < turned.index.size(); i += 3) std::swap(turned.index[i], turned.index[i + 1]);
  EXPECT_NEAR(total_volume(lattice(mesh_of({turned}), 0.15)), full, 1e-3 * full);
}

TEST(Lattice, ACavityStaysEmptyAndTwoBodiesStayTwo) {
  Primitive cavity = icosphere(3);
  for (vec3& p : cavity.position) p *= 0.5f;
  for (std::size_t i = 0; i < cavity.index.size(); i += 3) std::swap(cavity.index[i], cavity.index[i + 1]);
  const Mesh hollow = mesh_of({icosphere(4), cavity});
  EXPECT_NEAR(total_volume(lattice(hollow, 0.1)), enclosed_volume(hollow), 0.03 * enclosed_volume(hollow));

  Primitive beside = icosphere(4);
  for (vec3& p : beside.position) p += vec3(2.4f, 0, 0);
  const Mesh pair = mesh_of({icosphere(4), beside});
  const TetMesh mesh = lattice(pair, 0.15);
  for (std::uint32_t v = 0; v < pair.vertex_count; ++v)
    for (const std::uint32_t corner : mesh.tets[mesh.embedding[v].tet])
      EXPECT_EQ(mesh.nodes[corner].x > 1.2, pair.position(v).x > 1.2f) << "a vertex rides on the other body";
}

TEST(Lattice, ARingHardlyThickerThanACellStaysWhole) {
  const Mesh surface = mesh_of({torus(1.0f, 0.1f, 64, 16)});
  for (const double cell : {0.12, 0.11, 0.1}) {
    const TetMesh mesh = lattice(surface, cell);
    expect_sound(mesh);
    EXPECT_EQ(count_parts(mesh), 1u) << "at a cell of " << cell;
  }
  EXPECT_EQ(count_parts(surface), 1u);
  EXPECT_EQ(count_parts(mesh_of({icosphere(1), torus(3.0f, 0.5f, 12, 8)})), 2u);
  // Two elements that share an edge are connected like a hinge.
  TetMesh hinge;
  hinge.nodes.resize(6);
  hinge.tets = {{0, 1, 2, 3}, {0, 1, 4, 5}};
  EXPECT_EQ(count_parts(hinge), 2u);
  hinge.tets[1] = {0, 2, 1, 4};
  EXPECT_EQ(count_parts(hinge), 1u);
}

TEST(Lattice, WhatEnclosesNothingOrNeedsTooMuchIsRefusedInOneSentence) {
  const auto refusal = [](const Mesh& surface, double cell) {
    const Result<TetMesh> mesh = make_lattice(surface, cell);
    return mesh ? "" : mesh.error().message();
  };
  using testing::HasSubstr;
  EXPECT_THAT(refusal(mesh_of({sheet(4)}), 0.0), HasSubstr("encloses nothing"));
  EXPECT_THAT(refusal(mesh_of({sheet(4)}), 0.1), HasSubstr("encloses nothing"));
  EXPECT_THAT(refusal(mesh_of({icosphere(2)}, mat4(mat3(1.0f, 0, 0, 0, 0.001f, 0, 0, 0, 1.0f))), 0.3),
              HasSubstr("thinner than the cell"));
  EXPECT_THAT(refusal(mesh_of({icosphere(2)}), 1e-9), HasSubstr("choose a larger one"));
  EXPECT_THAT(refusal(mesh_of({icosphere(2)}), -1.0), HasSubstr("not a length"));
  EXPECT_THAT(refusal(mesh_of({icosphere(2)}), std::numeric_limits<double>::quiet_NaN()), HasSubstr("not a length"));
}

TEST(Lattice, TheSameBitsWhateverTheNumberOfThreads) {
  const Mesh surface = mesh_of({torus(1.0f, 0.3f, 64, 24)});
  std::vector<std::uint64_t> hashes;
  for (const unsigned threads : {1u, 3u}) {
    set_thread_count(threads);
    const TetMesh mesh = lattice(surface, 0.12);
    Hash hash;
    hash.add_bytes(mesh.nodes.data(), mesh.nodes.size() * sizeof(dvec3));
    hash.add_bytes(mesh.tets.data(), mesh.tets.size() * sizeof(Tet));
    for (const Embedding& e : mesh.embedding) {
      hash.add_bytes(&e.tet, sizeof e.tet);
      hash.add_bytes(e.weight.data(), sizeof e.weight);
    }
    hashes.push_back(hash.value());
  }
  set_thread_count(0);
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Inside, FarClustersAsDipolesAgreeWithTheSumOverEveryTriangle) {
  const Mesh surface = mesh_of({torus(1.0f, 0.3f, 64, 24)});
  const Inside inside(surface);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-1.6, 1.6);
  for (int i = 0; i < 500; ++i) {
    const dvec3 p(anywhere(random), anywhere(random), 0.4 * anywhere(random));
    const double ring = length(dvec2(p)) - 1.0, exact = inside.winding_by_sum(p);
    EXPECT_NEAR(inside.winding(p), exact, 0.05) << "0.5 decides";
    if (std::abs(length(dvec2(ring, p.z)) - 0.3) > 0.01) EXPECT_NEAR(exact, length(dvec2(ring, p.z)) < 0.3, 1e-9);
  }
}

TEST(Inside, WhatIsLookedUpIsWhatTheWindingNumberSays) {
  Primitive turned = torus(1.0f, 0.3f, 64, 24);
  for (std::size_t i = 0; i < turned.index.size(); i += 3) std::swap(turned.index[i], turned.index[i + 1]);
  Primitive beside = icosphere(3);
  for (vec3& p : beside.position) p = 0.4f * p + vec3(1.1f, 0.2f, 0.1f);  // through the ring's wall
  Primitive open = icosphere(3);
  open.index.resize(open.index.size() - 300);
  for (const std::vector<Primitive>& primitives : std::vector<std::vector<Primitive>>{
           {torus(1.0f, 0.3f, 64, 24)}, {turned}, {torus(1.0f, 0.3f, 64, 24), beside}, {open}, {icosphere(0)}}) {
    const Mesh surface = mesh_of(primitives);
    const Inside inside(surface);
    std::mt19937 random(11);
    const dvec3 low(surface.box.min), size(surface.box.size());
    std::uniform_real_distribution<double> share(-0.1, 1.1);
    int in = 0;
    for (int i = 0; i < 20000; ++i) {
      const dvec3 p = low + size * dvec3(share(random), share(random), share(random));
      ASSERT_EQ(inside(p), inside.by_winding(p)) << p.x << ' ' << p.y << ' ' << p.z;
      in += inside(p);
    }
    EXPECT_GT(in, 1000);
    for (std::uint32_t v = 0; v < surface.vertex_count; ++v)  // right beside the surface
      for (const double off : {-1e-3, 1e-3}) {
        const dvec3 p = dvec3(surface.position(v)) + off * dvec3(surface.normal(v));
        ASSERT_EQ(inside(p), inside.by_winding(p)) << v << ' ' << off;
      }
  }
}

// Lattices refined around a point.
TEST(TetFocus, WhatIsBroughtOutwardComesBackInward) {
  const LatticeFocus focus{dvec3(1, 2, 3), 0.02, dmat3(1.0)};
  double before = 0.0;
  for (const double q : {1e-6, 1e-3, 0.01, 0.02, 0.1, 1.0}) {
    const dvec3 out = focus.outward(dvec3(0, q, 0)) - focus.center;
    EXPECT_NEAR(focus.inward(out.y) / q, 1.0, 1e-9) << q;
    EXPECT_GT(out.y, before);
    before = out.y;
  }
  EXPECT_NEAR(focus.width(1e-6), 1.0, 1e-6);
  EXPECT_NEAR(focus.width(10.0), LatticeFocus::kGrowth, 1e-4);
}

TEST(TetFocus, FillsTheSameVolumeWithFineCellsWhereItIsAskedTo) {
  const Mesh surface = mesh_of({torus(0.10f, 0.04f, 48, 24)});
  const double volume = enclosed_volume(surface);
  const double c = std::cos(0.3), s = std::sin(0.3);
  const dmat3 turned(dvec3(c, s, 0), dvec3(-s, c, 0), dvec3(0, 0, 1));
  for (const dvec3 center : {dvec3(0.14, 0, 0), dvec3(0, 0.1, 0.04), dvec3(0.3, 0.3, 0.3)}) {
    const LatticeFocus focus{center, 0.02, turned};
    LatticeOptions options;
    options.cell = 0.005;
    options.focus = focus;
    const Result<TetMesh> mesh = fill_surface(surface, options);
    ASSERT_TRUE(mesh.ok()) << mesh.error().message();
    const TetMesh coarse = lattice(surface, LatticeFocus::kGrowth * options.cell);
    EXPECT_LT(std::abs(total_volume(*mesh) - volume), std::abs(total_volume(coarse) - volume));
    expect_conforming(*mesh);
    EXPECT_GT(mesh->quality.smallest_dihedral, 5 * kDegree) << "of a lattice drawn out by 1.8";
    // Every edge matches its cell: at most 1.8 times as long as wide, and a node may have moved onto the surface by
    // 0.4.
    double shortest = 1.0;
    for (const Tet& tet : mesh->tets)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = i + 1; k < 4; ++k) {
          const dvec3 a = mesh->nodes[tet[i]], b = mesh->nodes[tet[k]];
          const double width = options.cell * focus.width_at(0.5 * (a + b));
          EXPECT_LT(length(b - a), 2.2 * width);
          if (length(0.5 * (a + b) - center) < 0.02) shortest = std::min(shortest, length(b - a));
        }
    if (center.x < 0.3) EXPECT_LT(shortest, options.cell);
    const Result<TetMesh> even = fill_surface(surface, {options.cell, Fill::kSolid, 0.0, {}, {}});
    ASSERT_TRUE(even.ok());
    EXPECT_LT(mesh->tets.size(), even->tets.size() / 4);
  }
}

TEST(TetFocus, OfABodyIsItsBoxAndTheUsualNumberOfTetrahedraStays) {
  LevelNode node;
  node.name = "body";
  node.soft_body = SoftBody{};
  node.soft_body->focus = Box{vec3(0.09f, -0.02f, 0.0f), vec3(0.13f, 0.02f, 0.04f)};
  const LevelMesh ring{"ring", {torus(0.10f, 0.04f, 24, 12)}};
  const auto parts = make_soft_parts(node, &ring, mat4(1.0f), {});
  ASSERT_TRUE(parts.ok()) << parts.error().message();
  EXPECT_NEAR(static_cast<double>(parts->tets.tets.size()), kUsualTets, 0.3 * kUsualTets);
  node.soft_body->focus = {};
  const auto even = make_soft_parts(node, &ring, mat4(1.0f), {});
  ASSERT_TRUE(even.ok());
  EXPECT_LT(parts->tets.report.cell, 0.6 * even->tets.report.cell);
  // The surface is as fine as the cells behind it.
  const auto longest_near = [&](const SoftParts& of, bool inside) {
    double longest = 0.0;
    for (const uvec3& t : of.surface.mesh.triangles)
      for (int i = 0; i < 3; ++i) {
        const dvec3 a(of.surface.mesh.position(t[i])), b(of.surface.mesh.position(t[(i + 1) % 3]));
        const dvec3 away = 0.5 * (a + b) - dvec3(0.11, 0, 0.02);
        if ((length(away) < 0.02) == inside) longest = std::max(longest, length(b - a));
      }
    return longest;
  };
  EXPECT_LT(longest_near(*parts, true), 2.6 * parts->tets.report.cell);
  EXPECT_GT(longest_near(*parts, false), 2.6 * parts->tets.report.cell);
  node.soft_body->focus = Box{vec3(1.0f), vec3(1.1f)};
  const auto beside = make_soft_parts(node, &ring, mat4(1.0f), {});
  ASSERT_FALSE(beside.ok());
  EXPECT_THAT(beside.error().message(), testing::HasSubstr("lies beside the tissue"));
}

}  // namespace
}  // namespace pliant
