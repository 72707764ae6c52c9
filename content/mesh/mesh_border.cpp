#include "content/mesh/mesh_border.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace pliant {
namespace {

std::vector<std::uint32_t> border_vertices(const Mesh& mesh) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i)
      if (mesh.across[t][i] == kBorder) out.insert(out.end(), {mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]});
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace

std::uint32_t join_borders(const Mesh& mesh, const Welded& welded, Gathered& gathered) {
  using Cell = std::tuple<std::int64_t, std::int64_t, std::int64_t>;
  const std::vector<std::uint32_t> border = border_vertices(mesh);
  float extent = 0.0f;
  for (const vec3& p : welded.position) extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  const double near = extent * 0x1p-20;
  std::map<Cell, std::vector<std::uint32_t>> placed;  // the first of those that are near one another
  std::vector<std::uint32_t> onto(welded.position.size());
  for (std::uint32_t v = 0; v < onto.size(); ++v) onto[v] = v;
  std::uint32_t moved = 0;
  for (const std::uint32_t v : border) {
    const dvec3 p(welded.position[v]), at = glm::floor(p / near);
    const auto meets = [&](int dx, int dy, int dz) {
      const auto cell = placed.find(Cell(static_cast<std::int64_t>(at.x) + dx, static_cast<std::int64_t>(at.y) + dy,
                                         static_cast<std::int64_t>(at.z) + dz));
      if (cell == placed.end()) return false;
      for (const std::uint32_t other : cell->second)
        if (length(dvec3(welded.position[other]) - p) <= near) return onto[v] = other, true;
      return false;
    };
    bool met = false;
    for (int i = 0; i < 27 && !met; ++i) met = meets(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (met)
      ++moved;
    else
      placed[Cell(static_cast<std::int64_t>(at.x), static_cast<std::int64_t>(at.y), static_cast<std::int64_t>(at.z))]
          .push_back(v);
  }
  if (moved > 0)
    for (std::size_t source = 0; source < gathered.position.size(); ++source)
      if (const std::uint32_t v = welded.touch_vertex[source]; v != kNoVertex)
        gathered.position[source] = welded.position[onto[v]];
  return moved;
}

}  // namespace pliant
