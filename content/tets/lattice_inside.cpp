#include "content/tets/lattice_inside.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "content/tets/surface_rays.h"

namespace pliant {
namespace {

constexpr double kFarRadii = 2.3;  // [1] a cluster is a dipole from this many of its radii on
constexpr int kHalvings = 24;      // bisection steps across a hole

struct Visit {
  std::uint32_t level, box;
};
// Each level leaves at most kTreeWidth - 1 siblings on the stack; 32 levels hold any index.
constexpr std::size_t kDeepest = 32 * kTreeWidth;

}  // namespace

Inside::Inside(const Mesh& surface) : surface_(surface) {
  closed_ = !surface.across.empty() && std::none_of(surface.across.begin(), surface.across.end(), [](const uvec3& t) {
    return t.x == kBorder || t.y == kBorder || t.z == kBorder;
  });
  const auto& boxes = surface.tree.levels;
  const auto triangles = static_cast<std::uint32_t>(surface.triangles.size());
  std::vector<double> weight;  // [m2] of each cluster of the level below
  for (std::size_t level = 0; level < boxes.size(); ++level) {
    std::vector<Cluster> clusters(boxes[level].size());
    std::vector<double> weights(clusters.size(), 0.0);
    const std::uint32_t width = level == 0 ? kLeafSize : kTreeWidth;
    const auto below = level == 0 ? triangles : static_cast<std::uint32_t>(boxes[level - 1].size());
    for (std::uint32_t c = 0; c < clusters.size(); ++c) {
      Cluster& cluster = clusters[c];
      cluster.centre = cluster.area = dvec3(0);
      for (std::uint32_t i = c * width; i < std::min((c + 1) * width, below); ++i) {
        dvec3 centre, area;
        double size;
        if (level == 0) {
          const uvec3 t = surface.triangles[i];
          const dvec3 p(surface.position(t.x)), q(surface.position(t.y)), r(surface.position(t.z));
          centre = (p + q + r) / 3.0;
          area = 0.5 * cross(q - p, r - p);
          size = length(area);
        } else {
          centre = levels_[level - 1][i].centre;
          area = levels_[level - 1][i].area;
          size = weight[i];
        }
        cluster.centre += size * centre;
        cluster.area += area;
        weights[c] += size;
      }
      const Box& box = boxes[level][c];
      cluster.centre = weights[c] > 0.0 ? cluster.centre / weights[c] : dvec3(box.center());
      const dvec3 corner = glm::max(dvec3(box.max) - cluster.centre, cluster.centre - dvec3(box.min));
      cluster.reach2 = kFarRadii * kFarRadii * dot(corner, corner);
    }
    levels_.push_back(std::move(clusters));
    weight = std::move(weights);
  }
}

// Van Oosterom and Strackee, "The solid angle of a plane triangle", 1983.
double Inside::solid_angle(std::uint32_t triangle, dvec3 p) const {
  const uvec3 t = surface_.triangles[triangle];
  const dvec3 a = dvec3(surface_.position(t.x)) - p, b = dvec3(surface_.position(t.y)) - p,
              c = dvec3(surface_.position(t.z)) - p;
  const double la = length(a), lb = length(b), lc = length(c);
  return 2.0 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

double Inside::winding_by_sum(dvec3 p) const {
  double sum = 0.0;
  for (std::uint32_t t = 0; t < surface_.triangles.size(); ++t) sum += solid_angle(t, p);
  return sum / (4.0 * std::numbers::pi);
}

double Inside::winding(dvec3 p) const {
  Visit stack[kDeepest];
  std::size_t depth = 0;
  double sum = 0.0;
  stack[depth++] = {static_cast<std::uint32_t>(levels_.size() - 1), 0};
  while (depth > 0) {
    const Visit at = stack[--depth];
    const Cluster& cluster = levels_[at.level][at.box];
    const dvec3 away = cluster.centre - p;
    const double d2 = dot(away, away);
    if (d2 > cluster.reach2) {
      sum += dot(cluster.area, away) / (d2 * std::sqrt(d2));
    } else if (at.level == 0) {
      const auto end = std::min<std::size_t>((at.box + 1) * kLeafSize, surface_.triangles.size());
      for (std::uint32_t t = at.box * kLeafSize; t < end; ++t) sum += solid_angle(t, p);
    } else {
      const auto end = std::min<std::size_t>((at.box + 1) * kTreeWidth, levels_[at.level - 1].size());
      for (std::uint32_t c = at.box * kTreeWidth; c < end; ++c) stack[depth++] = {at.level - 1, c};
    }
  }
  return sum / (4.0 * std::numbers::pi);
}

bool Inside::is_uniform(dvec3 low, dvec3 high) const {
  if (!closed_) return false;
  Visit stack[kDeepest];
  std::size_t depth = 0;
  stack[depth++] = {static_cast<std::uint32_t>(levels_.size() - 1), 0};
  while (depth > 0) {
    const Visit at = stack[--depth];
    const Box& box = surface_.tree.levels[at.level][at.box];
    if (glm::any(glm::lessThan(dvec3(box.max), low)) || glm::any(glm::greaterThan(dvec3(box.min), high))) continue;
    if (at.level == 0) return false;
    const auto end = std::min<std::size_t>((at.box + 1) * kTreeWidth, levels_[at.level - 1].size());
    for (std::uint32_t c = at.box * kTreeWidth; c < end; ++c) stack[depth++] = {at.level - 1, c};
  }
  return true;
}

double Inside::crossing(dvec3 inside, dvec3 outside) const {
  const dvec3 along = outside - inside;
  std::vector<double> hits;
  find_hits(surface_, inside, along, hits);
  std::sort(hits.begin(), hits.end());
  double in = 0.0, out = 1.0;
  if (hits.empty()) {
    for (int n = 0; n < kHalvings; ++n) {
      const double middle = 0.5 * (in + out);
      ((*this)(inside + middle * along) ? in : out) = middle;
    }
    return 0.5 * (in + out);
  }
  // The side is constant between hits: bisect the intervals from the first (inside) to the last (outside).
  std::size_t first = 0, last = hits.size();
  while (last - first > 1) {
    const std::size_t middle = (first + last) / 2;
    ((*this)(inside + 0.5 * (hits[middle - 1] + hits[middle]) * along) ? first : last) = middle;
  }
  return hits[first];
}

}  // namespace pliant
