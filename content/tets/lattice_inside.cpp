#include "content/tets/lattice_inside.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "content/tets/surface_rays.h"

namespace pliant {
namespace {

constexpr double kFarRadii = 2.3;   // [1] a cluster is a dipole from this many of its radii on
constexpr int kHalvings = 24;       // bisection steps across a hole
constexpr double kGridBoxes = 2e5;  // 3 ms to make
constexpr double kMostAlong = 256;  // boxes along an axis

struct Visit {
  std::uint32_t level, box;
};
// Each level leaves at most kTreeWidth - 1 siblings on the stack; 32 levels hold any index.
constexpr std::size_t kDeepest = 32 * kTreeWidth;

}  // namespace

Inside::Inside(const Mesh& surface) : surface_(surface) {
  closed_ = is_closed();
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
  if (closed_) make_grid();
}

bool Inside::is_closed() const {
  const std::vector<uvec3>& triangles = surface_.triangles;
  if (surface_.across.empty()) return false;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t other = surface_.across[t][i];
      if (other == kBorder) return false;
      const uvec3 &own = triangles[t], &its = triangles[other];
      const std::uint32_t from = own[i], to = own[(i + 1) % 3];
      if (!((its.x == to && its.y == from) || (its.y == to && its.z == from) || (its.z == to && its.x == from)))
        return false;
    }
  return true;
}

void Inside::make_grid() {
  const Box& box = surface_.box;
  const dvec3 size(box.size());
  const double step = std::cbrt(size.x * size.y * size.z / kGridBoxes);
  if (!(step > 0.0)) return;
  count_ = glm::ivec3(glm::clamp(glm::ceil(size / step), dvec3(1), dvec3(kMostAlong)));
  low_ = dvec3(box.min);
  over_ = dvec3(count_) / size;
  count_ += 1;  // what lies on the far sides
  std::vector<Side> sides(
      static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y) * static_cast<std::size_t>(count_.z),
      Side::kFree);
  for (const uvec3& t : surface_.triangles) {
    const dvec3 p(surface_.position(t.x)), q(surface_.position(t.y)), r(surface_.position(t.z));
    const glm::ivec3 first = box_of(glm::min(p, glm::min(q, r))), last = box_of(glm::max(p, glm::max(q, r)));
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y) {
        const auto row = sides.begin() + number_of({0, y, z});
        std::fill(row + first.x, row + last.x + 1, Side::kUnknown);
      }
  }
  sides_ = std::move(sides);
  std::vector<std::uint32_t> part;
  for (std::uint32_t i = 0; i < sides_.size(); ++i)
    if (sides_[i] == Side::kFree) join(i, part);
}

// All free boxes that are reached from one get its side.
void Inside::join(std::uint32_t from, std::vector<std::uint32_t>& part) {
  const auto x = static_cast<std::uint32_t>(count_.x), y = static_cast<std::uint32_t>(count_.y);
  const auto place = [&](std::uint32_t i) { return glm::ivec3(i % x, i / x % y, i / x / y); };
  const Side side = by_winding(low_ + (dvec3(place(from)) + 0.5) / over_) ? Side::kInside : Side::kOutside;
  sides_[from] = side;
  part.assign(1, from);
  while (!part.empty()) {
    const glm::ivec3 at = place(part.back());
    part.pop_back();
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        glm::ivec3 next = at;
        next[axis] += step;
        if (next[axis] < 0 || next[axis] >= count_[axis]) continue;
        const std::uint32_t number = number_of(next);
        if (sides_[number] != Side::kFree) continue;
        sides_[number] = side;
        part.push_back(number);
      }
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
