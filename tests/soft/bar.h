// A straight bar of tetrahedra for tests: cells along x, y, z with Kuhn's six each; a predicate tells which nodes are
// free, on the handle or pinned. Its collision mesh is its border, with a vertex on each border node.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "components/mesh.h"
#include "components/tet_mesh.h"

namespace pliant {

struct Bar {
  TetMesh tets;
  Mesh collision_mesh;
};

enum class Role : std::uint8_t { kFree, kHandle, kBoneA, kBoneB, kPinned };  // bones: further rigid parts

// `role` of a node by its place in the grid; `cell` [m].
template <class RoleOf>
Bar make_bar(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, double cell, RoleOf role) {
  Bar bar;
  // Nodes in the order that TetMesh wants.
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> number;
  for (const Role wanted : {Role::kFree, Role::kHandle, Role::kBoneA, Role::kBoneB, Role::kPinned}) {
    const std::uint32_t before = bar.tets.node_count();
    for (std::uint32_t i = 0; i <= nx; ++i)
      for (std::uint32_t j = 0; j <= ny; ++j)
        for (std::uint32_t k = 0; k <= nz; ++k)
          if (role(i, j, k) == wanted) {
            number[{i, j, k}] = bar.tets.node_count();
            bar.tets.nodes.push_back(cell * dvec3(i, j, k));
            bar.tets.free_count += wanted == Role::kFree;
            bar.tets.handle_count += wanted == Role::kHandle;
          }
    const bool bone = wanted == Role::kBoneA || wanted == Role::kBoneB;
    if (bone && bar.tets.node_count() > before) bar.tets.rigid_counts.push_back(bar.tets.node_count() - before);
  }

  for (std::uint32_t i = 0; i < nx; ++i)
    for (std::uint32_t j = 0; j < ny; ++j)
      for (std::uint32_t k = 0; k < nz; ++k) {
        std::array<std::size_t, 3> path{0, 1, 2};
        do {
          std::array<std::uint32_t, 3> at{i, j, k};
          Tet tet{number[at], 0, 0, 0};
          for (std::size_t s = 0; s < 3; ++s) ++at[path[s]], tet[s + 1] = number[at];
          const auto& x = bar.tets.nodes;
          if (dot(cross(x[tet[1]] - x[tet[0]], x[tet[2]] - x[tet[0]]), x[tet[3]] - x[tet[0]]) < 0)
            std::swap(tet[2], tet[3]);
          bar.tets.tets.push_back(tet);
        } while (std::next_permutation(path.begin(), path.end()));
      }

  // Faces that one tetrahedron alone has, seen from outside.
  struct Face {
    std::array<std::uint32_t, 3> corner;
    std::uint32_t tet;
  };
  std::map<std::array<std::uint32_t, 3>, std::vector<Face>> faces;
  constexpr std::array<std::array<std::size_t, 3>, 4> kOutward{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  for (std::uint32_t t = 0; t < bar.tets.tets.size(); ++t)
    for (const auto& f : kOutward) {
      const Tet& tet = bar.tets.tets[t];
      const std::array<std::uint32_t, 3> corner{tet[f[0]], tet[f[1]], tet[f[2]]};
      std::array<std::uint32_t, 3> key = corner;
      std::sort(key.begin(), key.end());
      faces[key].push_back({corner, t});
    }
  std::map<std::uint32_t, std::uint32_t> vertex_of;
  for (const auto& [key, found] : faces) {
    if (found.size() != 1) continue;
    uvec3 triangle{0};
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t node = found[0].corner[static_cast<std::size_t>(c)];
      const auto [place, is_new] = vertex_of.try_emplace(node, bar.collision_mesh.vertex_count);
      triangle[c] = place->second;
      if (!is_new) continue;
      ++bar.collision_mesh.vertex_count;
      const vec3 x(bar.tets.nodes[node]);
      bar.collision_mesh.px.push_back(x.x), bar.collision_mesh.py.push_back(x.y), bar.collision_mesh.pz.push_back(x.z);
      Embedding place_in{.tet = found[0].tet, .weight = {0, 0, 0, 0}};
      const Tet& tet = bar.tets.tets[found[0].tet];
      place_in.weight[static_cast<std::size_t>(std::find(tet.begin(), tet.end(), node) - tet.begin())] = 1.0;
      bar.tets.embedding.push_back(place_in);
    }
    bar.collision_mesh.triangles.push_back(triangle);
  }
  return bar;
}

// A finger: pinned at x <= held, free beyond.
inline Bar make_finger(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, double cell, std::uint32_t held = 1) {
  return make_bar(nx, ny, nz, cell, [held](std::uint32_t i, std::uint32_t, std::uint32_t) {
    return i <= held ? Role::kHandle : Role::kFree;
  });
}

}  // namespace pliant
