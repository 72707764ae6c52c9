// Small meshes for tests of the mesh pipeline, in the form that a loader returns.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "components/curved_patch.h"
#include "components/mesh.h"
#include "content/level/level.h"
#include "content/mesh/mesh_build.h"

namespace pliant::test {

// A sphere of radius 1 [m] from an icosahedron, every triangle split in four `levels` times; closed, outward.
inline Primitive icosphere(int levels) {
  const float g = (1.0f + std::sqrt(5.0f)) / 2.0f;
  Primitive p;
  for (const vec3& v :
       {vec3(-1, g, 0), vec3(1, g, 0), vec3(-1, -g, 0), vec3(1, -g, 0), vec3(0, -1, g), vec3(0, 1, g), vec3(0, -1, -g),
        vec3(0, 1, -g), vec3(g, 0, -1), vec3(g, 0, 1), vec3(-g, 0, -1), vec3(-g, 0, 1)})
    p.position.push_back(vec3(normalize(dvec3(v))));
  p.index = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
             3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto key = std::make_pair(std::min(a, b), std::max(a, b));
      const auto [place, fresh] = middles.try_emplace(key, static_cast<std::uint32_t>(p.position.size()));
      if (fresh) p.position.push_back(vec3(normalize(dvec3(p.position[a]) + dvec3(p.position[b]))));
      return place->second;
    };
    std::vector<std::uint32_t> finer;
    for (std::size_t i = 0; i < p.index.size(); i += 3) {
      const std::uint32_t a = p.index[i], b = p.index[i + 1], c = p.index[i + 2];
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const std::uint32_t v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca}) finer.push_back(v);
    }
    p.index = finer;
  }
  return p;
}

// Every triangle with its own vertices, as in formats without sharing (STL).
inline Primitive unshared(const Primitive& shared) {
  Primitive p;
  for (const std::uint32_t v : shared.index) {
    p.index.push_back(static_cast<std::uint32_t>(p.position.size()));
    p.position.push_back(shared.position[v]);
  }
  return p;
}

// A box about the origin of 12 triangles: 24 vertices with the normals of its faces, or 8 without.
inline Primitive box(vec3 half, bool normals) {
  Primitive p;
  if (!normals)
    for (int i = 0; i < 8; ++i) p.position.push_back(half * vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      const auto corner = [&](int s, int t) {
        vec3 sign(0);
        sign[axis] = float(side), sign[next] = float(s), sign[last] = float(t * side);
        if (!normals) return static_cast<std::uint32_t>((sign.x > 0) + 2 * (sign.y > 0) + 4 * (sign.z > 0));
        vec3 normal(0);
        normal[axis] = float(side);
        p.position.push_back(half * sign);
        p.normal.push_back(normal);
        return static_cast<std::uint32_t>(p.position.size() - 1);
      };
      const std::uint32_t a = corner(-1, -1), b = corner(1, -1), c = corner(1, 1), d = corner(-1, 1);
      for (const std::uint32_t v : {a, b, c, a, c, d}) p.index.push_back(v);
    }
  return p;
}

// An n x n grid of squares over [0,1]^2 in the plane z = 0, facing +Z, with texture coordinates x, y.
inline Primitive sheet(std::uint32_t n) {
  Primitive p;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      p.position.emplace_back(float(i) / float(n), float(j) / float(n), 0.0f);
      p.uv.emplace_back(p.position.back());
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      for (const std::uint32_t v : {a, b, d, a, d, c}) p.index.push_back(v);
    }
  return p;
}

// Around the axis Y, radius 1, height 2, a fan on either end. `normals`: smooth on the side, flat on the ends.
inline Primitive cylinder(std::uint32_t n, bool normals) {
  Primitive p;
  const auto vertex = [&](vec3 position, vec3 normal) {
    p.position.push_back(position);
    if (normals) p.normal.push_back(normal);
    return static_cast<std::uint32_t>(p.position.size() - 1);
  };
  const auto rim = [&](std::uint32_t i, float y) {
    const double angle = 2.0 * std::numbers::pi * (i % n) / n;
    return vec3(float(std::cos(angle)), y, float(-std::sin(angle)));
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    const vec3 low = rim(i, -1), low_next = rim(i + 1, -1), high = rim(i, 1), high_next = rim(i + 1, 1);
    const auto side = [&](vec3 x) { return vertex(x, normalize(vec3(x.x, 0, x.z))); };
    for (const vec3& x : {low, low_next, high_next, low, high_next, high}) p.index.push_back(side(x));
    for (const vec3& x : {vec3(0, 1, 0), high, high_next}) p.index.push_back(vertex(x, {0, 1, 0}));
    for (const vec3& x : {vec3(0, -1, 0), low_next, low}) p.index.push_back(vertex(x, {0, -1, 0}));
  }
  return p;
}

// A band of latitudes and longitudes: 48 triangles at 6 x 5.
inline Primitive globe(std::uint32_t around, std::uint32_t down) {
  Primitive p;
  const auto add = [&](std::uint32_t i, std::uint32_t j) {
    const double a = 2 * std::numbers::pi * (i % around) / around, b = std::numbers::pi * j / down;
    p.index.push_back(static_cast<std::uint32_t>(p.position.size()));
    const double s = j == 0 || j == down ? 0.0 : std::sin(b);
    p.position.emplace_back(s * std::cos(a), std::cos(b), -s * std::sin(a));
  };
  for (std::uint32_t j = 0; j < down; ++j)
    for (std::uint32_t i = 0; i < around; ++i) {
      if (j + 1 < down) add(i, j), add(i, j + 1), add(i + 1, j + 1);
      if (j > 0) add(i, j), add(i + 1, j + 1), add(i + 1, j);
    }
  return p;
}

// A Level of one scene: one node with this mesh, for spawn.
inline Level level_of(Primitive primitive, const LocalTransform& local = {}) {
  Level level;
  level.name = "test";
  level.path = "test.gltf";
  level.meshes.push_back({"mesh", {std::move(primitive)}});
  LevelNode node;
  node.name = "thing";
  node.mesh = 0;
  node.local = local;
  node.deformable = Deformable{};
  level.nodes.push_back(node);
  return level;
}

// [m3] of a closed surface; > 0: its normals point outward.
inline double enclosed_volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const uvec3& t : mesh.triangles)
    sum += dot(dvec3(mesh.position(t.x)), cross(dvec3(mesh.position(t.y)), dvec3(mesh.position(t.z)))) / 6.0;
  return sum;
}

// The largest gap between the patches on both sides of an edge, as a share of that edge.
inline double worst_gap(const Mesh& mesh) {
  double worst = 0.0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const CurvedPatch own = curved_patch(mesh, t);
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t other = mesh.across[t][i];
      if (other == kBorder) continue;
      const CurvedPatch theirs = curved_patch(mesh, other);
      const std::uint32_t from = mesh.triangles[t][i], to = mesh.triangles[t][(i + 1) % 3];
      int a = 0, b = 0;
      for (int k = 0; k < 3; ++k) {
        if (mesh.triangles[other][k] == from) a = k;
        if (mesh.triangles[other][k] == to) b = k;
      }
      const auto at = [](const CurvedPatch& patch, int first, int second, double s) {
        double w[3] = {0, 0, 0};
        w[first] = 1 - s;
        w[second] = s;
        return patch.at(w[1], w[2]).p;
      };
      const double edge = length(own.b[(i + 1) % 3] - own.b[i]);
      for (const double s : {0.125, 0.25, 0.5, 0.75, 0.9})
        worst = std::max(worst, length(at(own, i, (i + 1) % 3, s) - at(theirs, a, b, s)) / edge);
    }
  }
  return worst;
}

inline BuiltMesh build(const Primitive& p, const mat4& to_object = mat4(1.0f)) {
  Result<BuiltMesh> built = build_mesh("test", {&p, 1}, to_object);
  EXPECT_TRUE(built.ok()) << built.error().message();
  return std::move(*built);
}

}  // namespace pliant::test
