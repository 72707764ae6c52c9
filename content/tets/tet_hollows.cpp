#include "content/tets/tet_hollows.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "content/tets/tet_boundary.h"

namespace pliant {
namespace {

// Number of the connected part of each triangle: those with an edge in common, if the edge has no other triangles.
std::vector<std::size_t> joined_parts(const std::vector<uvec3>& triangles) {
  std::vector<std::size_t> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::size_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::size_t>> edges;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) edges[std::minmax(triangles[t][i], triangles[t][(i + 1) % 3])].push_back(t);
  for (const auto& [edge, sides] : edges)
    if (sides.size() == 2) parent[root(sides[0])] = root(sides[1]);
  for (std::size_t t = 0; t < triangles.size(); ++t) parent[t] = root(t);
  return parent;
}

}  // namespace

std::vector<std::vector<uvec3>> hollows_of(const TetMesh& mesh) {
  const std::vector<uvec3> border = boundary_triangles(mesh.tets);
  const std::vector<std::size_t> part = joined_parts(border);
  std::map<std::size_t, std::vector<uvec3>> walls;
  for (std::size_t t = 0; t < border.size(); ++t)
    walls[part[t]].emplace_back(border[t].x, border[t].z, border[t].y);  // seen from the tissue
  std::vector<std::vector<uvec3>> out;
  for (auto& [number, wall] : walls) {
    double volume = 0.0;
    const dvec3 o = mesh.nodes[wall.front().x];
    for (const uvec3& t : wall) volume += dot(mesh.nodes[t.x] - o, cross(mesh.nodes[t.y] - o, mesh.nodes[t.z] - o));
    if (volume > 0.0) out.push_back(std::move(wall));
  }
  return out;
}

}  // namespace pliant
