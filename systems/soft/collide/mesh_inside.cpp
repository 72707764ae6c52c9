// Inside test of a collision mesh: the nearest feature, and the side of its pseudonormal (Baerentzen & Aanaes 2005,
// angle-weighted: the only weights that are correct at every vertex).
#include <algorithm>
#include <cmath>

#include "systems/soft/collide/collision_mesh.h"

namespace pliant {
namespace {

struct Nearest {
  double distance2;
  std::uint32_t triangle = kBorder;
  dvec3 barycentric{1, 0, 0};
};

// The triangle's nearest point (Ericson, Real-Time Collision Detection, 5.1.5), by the regions of its plane.
dvec3 nearest_barycentric(dvec3 p, dvec3 a, dvec3 b, dvec3 c) {
  const dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0.0 && d2 <= 0.0) return {1, 0, 0};
  if (d3 >= 0.0 && d4 <= d3) return {0, 1, 0};
  if (d6 >= 0.0 && d5 <= d6) return {0, 0, 1};
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {1.0 - d1 / (d1 - d3), d1 / (d1 - d3), 0.0};
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {1.0 - d2 / (d2 - d6), 0.0, d2 / (d2 - d6)};
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    const double s = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0.0, 1.0 - s, s};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

double distance2_to(const Box& box, vec3 p) {
  const vec3 d = glm::max(glm::max(box.min - p, p - box.max), vec3(0.0f));
  return static_cast<double>(dot(d, d));
}

double angle_at(dvec3 a, dvec3 b, dvec3 c) {
  return std::atan2(length(cross(b - a, c - a)), dot(b - a, c - a));
}

}  // namespace

bool CollisionMesh::contains(dvec3 p, double reach) const {
  if (boxes_.empty()) return false;
  Nearest best{reach * reach};
  const vec3 pf(p);
  // Depth first; boxes are conservative.
  std::array<std::pair<std::uint32_t, std::uint32_t>, 128> stack;
  std::size_t top = 0;
  stack[top++] = {static_cast<std::uint32_t>(boxes_.size() - 1), 0};
  while (top > 0) {
    const auto [level, index] = stack[--top];
    if (distance2_to(boxes_[level][index], pf) > best.distance2) continue;
    if (level > 0) {
      const std::uint32_t end =
          std::min<std::uint32_t>((index + 1) * kTreeWidth, static_cast<std::uint32_t>(boxes_[level - 1].size()));
      for (std::uint32_t k = index * kTreeWidth; k < end; ++k) stack[top++] = {level - 1, k};
      continue;
    }
    const std::uint32_t end =
        std::min<std::uint32_t>((index + 1) * kLeafSize, static_cast<std::uint32_t>(mesh_->triangles.size()));
    for (std::uint32_t t = index * kLeafSize; t < end; ++t) {
      const uvec3 c = mesh_->triangles[t];
      if (normal_[t] == dvec3(0.0)) continue;
      const dvec3 w = nearest_barycentric(p, position_[c.x], position_[c.y], position_[c.z]);
      const dvec3 d = p - (w.x * position_[c.x] + w.y * position_[c.y] + w.z * position_[c.z]);
      if (dot(d, d) < best.distance2) best = {dot(d, d), t, w};
    }
  }
  if (best.triangle == kBorder) return false;

  const uvec3 c = mesh_->triangles[best.triangle];
  const dvec3 w = best.barycentric;
  const dvec3 away = p - (w.x * position_[c.x] + w.y * position_[c.y] + w.z * position_[c.z]);
  dvec3 outward = normal_[best.triangle];
  for (int i = 0; i < 3; ++i) {
    if (w[i] == 1.0) {
      outward = dvec3(0.0);
      for (std::uint32_t k = triangles_first_[c[i]]; k < triangles_first_[c[i] + 1]; ++k) {
        const uvec3 o = mesh_->triangles[triangles_of_[k]];
        const int at = o.x == c[i] ? 0 : o.y == c[i] ? 1 : 2;
        outward += normal_[triangles_of_[k]] *
                   angle_at(position_[c[i]], position_[o[(at + 1) % 3]], position_[o[(at + 2) % 3]]);
      }
      break;
    }
    if (w[i] == 0.0 && w[(i + 1) % 3] != 1.0 && w[(i + 2) % 3] != 1.0) {
      const CollisionEdge& edge = edges_[edge_of_[best.triangle][(i + 1) % 3]];
      outward = normal_[edge.triangle[0]] + normal_[edge.triangle[1]];
      break;
    }
  }
  return dot(away, outward) < 0.0;
}

}  // namespace pliant
