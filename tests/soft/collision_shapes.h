// Closed surfaces for tests of contact, as touch meshes.
#pragma once

#include <array>
#include <functional>
#include <random>

#include "content/mesh/mesh_build.h"
#include "tests/content/mesh_shapes.h"

namespace pliant::test {

inline Mesh mesh_of(const Primitive& primitive) {
  auto built = build_mesh("test", std::span(&primitive, 1), mat4(1));
  return std::move(built->mesh);
}

// A sphere of radius r [m] about the origin.
inline Mesh sphere_mesh(float r, int levels) {
  Primitive p = icosphere(levels);
  for (vec3& x : p.position) x *= r;
  return mesh_of(p);
}

// The surface of those cells [m] of an nx x ny x nz grid for which `full` is true; its corner is at `origin`.
inline Mesh voxel_mesh(int nx, int ny, int nz, vec3 cell, vec3 origin, const std::function<bool(int, int, int)>& full) {
  Primitive p;
  const auto at = [&](int i, int j, int k) {
    return i >= 0 && j >= 0 && k >= 0 && i < nx && j < ny && k < nz && full(i, j, k);
  };
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        if (!at(i, j, k)) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (const int side : {0, 1}) {
            glm::ivec3 next(i, j, k);
            next[axis] += side ? 1 : -1;
            if (at(next.x, next.y, next.z)) continue;
            const int u = (axis + (side ? 1 : 2)) % 3, v = (axis + (side ? 2 : 1)) % 3;
            const std::uint32_t first = static_cast<std::uint32_t>(p.position.size());
            for (const auto& [du, dv] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
              glm::ivec3 corner(i, j, k);
              corner[axis] += side;
              corner[u] += du;
              corner[v] += dv;
              p.position.push_back(origin + vec3(corner) * cell);
            }
            for (const std::uint32_t c : {0u, 1u, 2u, 0u, 2u, 3u}) p.index.push_back(first + c);
          }
      }
  return mesh_of(p);
}

// A block of `size` [m] about the origin, its faces in n x n squares.
inline Mesh block_mesh(vec3 size, int n = 1) {
  return voxel_mesh(n, n, n, size / float(n), -0.5f * size, [](int, int, int) { return true; });
}

// A block of `size` x `size` [m] about the y axis whose top is y = height(x, z) over n x n squares and whose bottom is
// y = `floor`; `open`: the top alone, a sheet that faces up.
inline Mesh relief_mesh(float size, int n, float floor, bool open, const std::function<float(float, float)>& height) {
  Primitive p;
  const auto add = [&](std::array<vec3, 3> corners) {
    for (const vec3& x : corners) {
      p.index.push_back(static_cast<std::uint32_t>(p.position.size()));
      p.position.push_back(x);
    }
  };
  const auto top = [&](int i, int k) {
    const float x = size * (float(i) / float(n) - 0.5f), z = size * (float(k) / float(n) - 0.5f);
    return vec3(x, height(x, z), z);
  };
  const auto below = [&](vec3 x) { return vec3(x.x, floor, x.z); };
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const std::array<vec3, 4> c{top(i, k), top(i, k + 1), top(i + 1, k + 1), top(i + 1, k)};
      add({c[0], c[1], c[2]});
      add({c[0], c[2], c[3]});
      if (open) continue;
      add({below(c[0]), below(c[2]), below(c[1])});
      add({below(c[0]), below(c[3]), below(c[2])});
      const std::array<bool, 4> border{i == 0, k == n - 1, i == n - 1, k == 0};
      for (std::size_t side = 0; side < 4; ++side) {
        if (!border[side]) continue;
        const vec3 a = c[side], b = c[(side + 1) % 4];
        add({b, a, below(a)});
        add({b, below(a), below(b)});
      }
    }
  return mesh_of(p);
}

inline dvec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return normalize(dvec3(normal(random), normal(random), normal(random)));
}

}  // namespace pliant::test
