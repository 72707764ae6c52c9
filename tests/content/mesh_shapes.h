// Small meshes for tests of the mesh pipeline, as a loader would hand them over.
#pragma once

#include <cmath>
#include <map>
#include <vector>

#include "components/mesh.h"
#include "content/level.h"

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

// Every triangle with corners of its own, as formats without sharing (STL) deliver.
inline Primitive unshared(const Primitive& shared) {
  Primitive p;
  for (const std::uint32_t v : shared.index) {
    p.index.push_back(static_cast<std::uint32_t>(p.position.size()));
    p.position.push_back(shared.position[v]);
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

}  // namespace pliant::test
