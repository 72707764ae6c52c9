#include "engine/session/triangle_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/session/source_place.h"

namespace pliant {
namespace {

constexpr std::uint32_t kTrianglesInALeaf = 4;

double distance_to_box(dvec3 low, dvec3 high, dvec3 x) {
  return length(glm::max(dvec3(0), glm::max(low - x, x - high)));
}

// Entry distance of a ray into a box [m], or infinity. A ray in the plane of a face counts as inside (0 times
// infinity).
double entry_to_box(dvec3 low, dvec3 high, dvec3 from, dvec3 inverse, double within) {
  double enter = 0.0, leave = within;
  for (int k = 0; k < 3; ++k) {
    const double a = (low[k] - from[k]) * inverse[k], b = (high[k] - from[k]) * inverse[k];
    if (std::isnan(a) || std::isnan(b)) continue;
    enter = std::max(enter, std::min(a, b) * (1 - 1e-15));
    leave = std::min(leave, std::max(a, b) * (1 + 1e-15));
  }
  return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

// Woop, Benthin and Wald 2013: a hit on a shared edge is found by at least one triangle. `axis`: the direction's
// largest component, by which the others are sheared.
TrianglePlace meet_triangle(dvec3 a, dvec3 b, dvec3 c, dvec3 from, dvec3 way, int axis) {
  const int kx = (axis + 1) % 3, ky = (axis + 2) % 3;
  const dvec3 shear{way[kx] / way[axis], way[ky] / way[axis], 1.0 / way[axis]};
  const auto sheared = [&](dvec3 p) {
    p -= from;
    return dvec3{p[kx] - shear.x * p[axis], p[ky] - shear.y * p[axis], shear.z * p[axis]};
  };
  const dvec3 A = sheared(a), B = sheared(b), C = sheared(c);
  const double u = C.x * B.y - C.y * B.x, v = A.x * C.y - A.y * C.x, w = B.x * A.y - B.y * A.x;
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return {};
  const double sum = u + v + w;
  if (sum == 0.0) return {};
  const double along = (u * A.z + v * B.z + w * C.z) / sum;
  if (!(along >= 0.0)) return {};
  return {0, dvec3(u, v, w) / sum, along};
}

}  // namespace

TriangleBoxes::TriangleBoxes(std::vector<dvec3> positions, std::vector<uvec3> triangles,
                             const std::vector<std::uint8_t>& members)
    : positions_(std::move(positions)), triangles_(std::move(triangles)) {
  std::vector<dvec3> middle(triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    if (!members[t]) continue;
    members_.push_back(t);
    middle[t] = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0;
  }
  if (members_.empty()) return;
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(members_.size()), middle);
  fit(std::move(positions_));
}

// Splits at the median of the longest side: the depth is log2 of the count for any triangles.
void TriangleBoxes::split(std::uint32_t node, std::uint32_t first, std::uint32_t count,
                          const std::vector<dvec3>& middle) {
  if (count <= kTrianglesInALeaf) {
    nodes_[node].first = first, nodes_[node].count = count;
    return;
  }
  const auto begin = members_.begin() + first;
  dvec3 low = middle[*begin], high = low;
  for (std::uint32_t i = 1; i < count; ++i)
    low = glm::min(low, middle[begin[i]]), high = glm::max(high, middle[begin[i]]);
  const dvec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t half = count / 2;
  std::nth_element(begin, begin + half, begin + count,
                   [&](std::uint32_t s, std::uint32_t t) { return middle[s][axis] < middle[t][axis]; });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = child;
  nodes_.resize(nodes_.size() + 2);
  split(child, first, half, middle);
  split(child + 1, first + half, count - half, middle);
}

void TriangleBoxes::fit(std::vector<dvec3> positions) {
  positions_ = std::move(positions);
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    if (node.count == 0) {
      const Node &a = nodes_[node.first], &b = nodes_[node.first + 1];
      node.low = glm::min(a.low, b.low), node.high = glm::max(a.high, b.high);
      continue;
    }
    node.low = node.high = corner(members_[node.first], 0);
    for (std::uint32_t i = 0; i < node.count; ++i)
      for (int k = 0; k < 3; ++k) {
        const dvec3 p = corner(members_[node.first + i], k);
        node.low = glm::min(node.low, p), node.high = glm::max(node.high, p);
      }
  }
}

TrianglePlace TriangleBoxes::closest(dvec3 x, double within) const {
  TrianglePlace best;
  if (empty()) return best;
  std::array<std::uint32_t, 64> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    const double most = std::min(best.distance, within);
    if (distance_to_box(node.low, node.high, x) > most) continue;
    if (node.count == 0) {
      const Node &a = nodes_[node.first], &b = nodes_[node.first + 1];
      const bool swap = distance_to_box(a.low, a.high, x) < distance_to_box(b.low, b.high, x);
      stack[top++] = node.first + (swap ? 1 : 0);  // the nearer one is visited first
      stack[top++] = node.first + (swap ? 0 : 1);
      continue;
    }
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t t = members_[node.first + i];
      const dvec3 w = nearest_weights(corner(t, 0), corner(t, 1), corner(t, 2), x);
      const double distance = length(w.x * corner(t, 0) + w.y * corner(t, 1) + w.z * corner(t, 2) - x);
      if (distance <= within && distance < best.distance) best = {t, w, distance};
    }
  }
  return best;
}

TrianglePlace TriangleBoxes::first_along(dvec3 from, dvec3 way, double within) const {
  TrianglePlace best;
  if (empty()) return best;
  const dvec3 inverse = 1.0 / way, size = glm::abs(way);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::array<std::uint32_t, 64> stack;
  std::size_t top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    const double most = std::min(best.distance, within);
    if (!(entry_to_box(node.low, node.high, from, inverse, most) <= most)) continue;
    if (node.count == 0) {
      const Node &a = nodes_[node.first], &b = nodes_[node.first + 1];
      const bool swap =
          entry_to_box(a.low, a.high, from, inverse, most) < entry_to_box(b.low, b.high, from, inverse, most);
      stack[top++] = node.first + (swap ? 1 : 0);
      stack[top++] = node.first + (swap ? 0 : 1);
      continue;
    }
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t t = members_[node.first + i];
      TrianglePlace met = meet_triangle(corner(t, 0), corner(t, 1), corner(t, 2), from, way, axis);
      if (met.distance <= within && met.distance < best.distance) best = met, best.triangle = t;
    }
  }
  return best;
}

}  // namespace pliant
