#include "content/mesh/enclosing_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "content/mesh/mesh_build.h"

namespace pliant {
namespace {

constexpr double kNearEdge = 1e-9;  // [1] barycentric: a ray this close to a triangle's edge may hit twice

bool meets_box(const Box& box, dvec3 from, dvec3 over) {
  double in = 0.0, out = std::numeric_limits<double>::max();
  for (int i = 0; i < 3; ++i) {
    const double a = (static_cast<double>(box.min[i]) - from[i]) * over[i];
    const double b = (static_cast<double>(box.max[i]) - from[i]) * over[i];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return in <= out * (1 + 1e-12);
}

}  // namespace

EnclosingParts::EnclosingParts(const Mesh& mesh, const std::vector<std::uint32_t>& part_of)
    : mesh_(mesh), part_of_(part_of), tree_(build_tree(mesh)) {}

std::optional<std::vector<std::uint32_t>> EnclosingParts::around(std::uint32_t triangle) {
  const uvec3 t = mesh_.triangles[triangle];
  const dvec3 from = (dvec3(mesh_.position(t.x)) + dvec3(mesh_.position(t.y)) + dvec3(mesh_.position(t.z))) / 3.0;
  // Directions that no modelled surface is parallel to.
  for (const dvec3& along : {dvec3(0.1371, 0.9713, 0.1947), dvec3(-0.8377, 0.2411, 0.4901),
                             dvec3(0.3299, -0.4423, 0.8343), dvec3(0.6151, -0.7013, -0.3607)}) {
    hits_.clear();
    if (!cast(from, along, part_of_[triangle])) continue;
    std::sort(hits_.begin(), hits_.end());
    std::vector<std::uint32_t> odd;
    for (std::size_t i = 0; i < hits_.size();) {
      std::size_t j = i;
      while (j < hits_.size() && hits_[j] == hits_[i]) ++j;
      if ((j - i) % 2 == 1) odd.push_back(hits_[i]);
      i = j;
    }
    return odd;
  }
  return std::nullopt;
}

// False: it passes too near to an edge, or starts on a surface.
bool EnclosingParts::cast(dvec3 from, dvec3 along, std::uint32_t own) {
  const dvec3 over = 1.0 / along;
  const auto& levels = tree_.levels;
  waiting_.assign(1, {levels.size() - 1, 0});
  while (!waiting_.empty()) {
    const auto [level, box] = waiting_.back();
    waiting_.pop_back();
    if (!meets_box(levels[level][box], from, over)) continue;
    if (level > 0) {
      const std::size_t end = std::min((box + 1) * kTreeWidth, levels[level - 1].size());
      for (std::size_t i = box * kTreeWidth; i < end; ++i) waiting_.push_back({level - 1, i});
      continue;
    }
    const std::size_t end = std::min((box + 1) * kLeafSize, mesh_.triangles.size());
    for (std::size_t i = box * kLeafSize; i < end; ++i)
      if (part_of_[i] != own && !meet(from, along, static_cast<std::uint32_t>(i))) return false;
  }
  return true;
}

// Moeller & Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
bool EnclosingParts::meet(dvec3 from, dvec3 along, std::uint32_t triangle) {
  const uvec3 t = mesh_.triangles[triangle];
  const dvec3 a(mesh_.position(t.x)), e = dvec3(mesh_.position(t.y)) - a, f = dvec3(mesh_.position(t.z)) - a;
  const dvec3 h = cross(along, f), s = from - a, q = cross(s, e);
  const double determinant = dot(e, h);
  const double size = length(e) * length(f);
  if (std::abs(determinant) <= 1e-12 * size) return true;  // edge-on; its neighbours' edges decide whether it matters
  const double u = dot(s, h) / determinant, v = dot(along, q) / determinant, w = 1 - u - v;
  const double least = std::min({u, v, w});
  if (least < -kNearEdge) return true;
  const double far = dot(f, q) / determinant;
  if (std::abs(far) <= 1e-7 * std::sqrt(size)) return false;
  if (far < 0) return true;
  if (least < kNearEdge) return false;
  hits_.push_back(part_of_[triangle]);
  return true;
}

}  // namespace pliant
