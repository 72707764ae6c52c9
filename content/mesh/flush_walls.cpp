#include "content/mesh/flush_walls.h"

#include <algorithm>
#include <numeric>

namespace pliant {
namespace {

struct FlushSide {
  std::uint32_t low, high;  // vertices of the edge
  std::uint32_t triangle;
  auto operator<=>(const FlushSide&) const = default;
  bool same_edge(const FlushSide& other) const { return low == other.low && high == other.high; }
};

// Sides of the triangles around each edge of a two-sided one.
std::vector<FlushSide> sides_of(std::span<const uvec3> triangle, const std::vector<std::uint8_t>& two_sided,
                                std::size_t vertices) {
  std::vector<std::uint8_t> near(vertices, 0);
  for (std::size_t t = 0; t < triangle.size(); ++t)
    if (two_sided[t])
      for (int i = 0; i < 3; ++i) near[triangle[t][i]] = 1;
  std::vector<FlushSide> sides;
  for (std::uint32_t t = 0; t < triangle.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle[t][i], b = triangle[t][(i + 1) % 3];
      if (near[a] && near[b]) sides.push_back({std::min(a, b), std::max(a, b), t});
    }
  std::sort(sides.begin(), sides.end());
  return sides;
}

// A triangle at an edge: its outer normal, and the way from the edge into it.
struct EdgeFace {
  dvec3 normal, away;
};
EdgeFace face_at(std::span<const vec3> position, std::span<const uvec3> triangle, const FlushSide& side) {
  const uvec3 t = triangle[side.triangle];
  const dvec3 p(position[t.x]), q(position[t.y]), r(position[t.z]), from(position[side.low]);
  const std::uint32_t third = t.x ^ t.y ^ t.z ^ side.low ^ side.high;
  const dvec3 along = normalize(dvec3(position[side.high]) - from), way = dvec3(position[third]) - from;
  return {normalize(cross(q - p, r - p)), normalize(way - dot(way, along) * along)};
}

// Whether the way `into` from the edge of two adjacent faces lies in the tissue behind them.
bool in_tissue(const EdgeFace& one, const EdgeFace& other, dvec3 into) {
  const bool convex = dot(one.normal, other.away) < 0;
  const bool behind_one = dot(one.normal, into) < 0, behind_other = dot(other.normal, into) < 0;
  return convex ? behind_one && behind_other : behind_one || behind_other;
}

}  // namespace

std::vector<std::uint8_t> flush_walls(std::span<const vec3> position, std::span<const uvec3> triangle,
                                      const std::vector<std::uint8_t>& two_sided) {
  std::vector<std::uint8_t> wall(triangle.size(), 0);
  if (std::find(two_sided.begin(), two_sided.end(), 1) == two_sided.end()) return wall;
  const std::vector<FlushSide> sides = sides_of(triangle, two_sided, position.size());
  // Connected parts of the two-sided triangles; `bare`: a part whose rim is not in tissue.
  std::vector<std::uint32_t> part(triangle.size());
  std::iota(part.begin(), part.end(), 0u);
  const auto root = [&](std::uint32_t t) {
    while (part[t] != t) t = part[t] = part[part[t]];
    return t;
  };
  std::vector<std::uint8_t> bare(triangle.size(), 0);
  for (const bool joining : {true, false})
    for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
      while (end < sides.size() && sides[end].same_edge(sides[i])) ++end;
      std::vector<FlushSide> walls, others;
      for (std::size_t k = i; k < end; ++k) (two_sided[sides[k].triangle] ? walls : others).push_back(sides[k]);
      if (walls.empty()) continue;
      if (joining) {
        for (const FlushSide& side : walls) part[root(side.triangle)] = root(walls[0].triangle);
        continue;
      }
      if (others.empty() && walls.size() > 1) continue;  // inside the part
      bool surrounded = others.size() == 2;
      if (surrounded) {
        const EdgeFace one = face_at(position, triangle, others[0]), other = face_at(position, triangle, others[1]);
        for (const FlushSide& side : walls)
          surrounded = surrounded && in_tissue(one, other, face_at(position, triangle, side).away);
      }
      if (!surrounded) bare[root(walls[0].triangle)] = 1;
    }
  for (std::uint32_t t = 0; t < triangle.size(); ++t) wall[t] = two_sided[t] && !bare[root(t)];
  return wall;
}

}  // namespace pliant
