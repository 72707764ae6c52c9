#include "content/tets/surface_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pliant {
namespace {

struct RayVisit {
  std::uint32_t level, box;
};
// Each level leaves at most kTreeWidth - 1 siblings on the stack; 32 levels hold any index.
constexpr std::size_t kDeepestRay = 32 * kTreeWidth;

// Whether the ray from + s along, s in [0, far], meets the box; `over` is 1 / along.
bool meets(const Box& box, dvec3 from, dvec3 along, dvec3 over, double far) {
  double in = 0.0, out = far;
  for (int i = 0; i < 3; ++i) {
    const double low = static_cast<double>(box.min[i]), high = static_cast<double>(box.max[i]);
    if (along[i] == 0.0) {
      if (from[i] < low || from[i] > high) return false;
      continue;
    }
    const double a = (low - from[i]) * over[i], b = (high - from[i]) * over[i];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return in <= out + 1e-9;
}

// Moeller and Trumbore, "Fast, minimum storage ray/triangle intersection", 1997. Calls hit(triangle, share) for every
// triangle met at shares in [0, far]; hit may lower `far`, and ends the search by returning true.
template <class Hit>
bool cast(const Mesh& surface, dvec3 from, dvec3 along, const double& far, Hit hit) {
  const auto& boxes = surface.tree.levels;
  const dvec3 over = 1.0 / along;
  RayVisit stack[kDeepestRay];
  std::size_t depth = 0;
  stack[depth++] = {static_cast<std::uint32_t>(boxes.size() - 1), 0};
  while (depth > 0) {
    const RayVisit at = stack[--depth];
    if (!meets(boxes[at.level][at.box], from, along, over, far)) continue;
    if (at.level > 0) {
      const auto end = std::min<std::size_t>((at.box + 1) * kTreeWidth, boxes[at.level - 1].size());
      for (std::uint32_t c = at.box * kTreeWidth; c < end; ++c) stack[depth++] = {at.level - 1, c};
      continue;
    }
    const auto end = std::min<std::size_t>((at.box + 1) * kLeafSize, surface.triangles.size());
    for (std::uint32_t i = at.box * kLeafSize; i < end; ++i) {
      const uvec3 t = surface.triangles[i];
      const dvec3 a(surface.position(t.x)), ab = dvec3(surface.position(t.y)) - a,
                                            ac = dvec3(surface.position(t.z)) - a;
      const dvec3 p = cross(along, ac), s = from - a, q = cross(s, ab);
      const double det = dot(ab, p), u = dot(s, p) / det, v = dot(along, q) / det, share = dot(ac, q) / det;
      if (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && share >= 0.0 && share <= far && hit(i, share)) return true;
    }
  }
  return false;
}

double distance(const Box& box, dvec3 p) {
  return length(glm::max(glm::max(dvec3(box.min) - p, p - dvec3(box.max)), dvec3(0)));
}

void find_closest(const Mesh& surface, dvec3 p, RayVisit at, RayPoint& best) {
  const auto& boxes = surface.tree.levels;
  if (at.level == 0) {
    const auto end = std::min<std::size_t>((at.box + 1) * kLeafSize, surface.triangles.size());
    for (std::uint32_t i = at.box * kLeafSize; i < end; ++i) {
      const uvec3 t = surface.triangles[i];
      const dvec3 foot = closest_on_triangle(p, dvec3(surface.position(t.x)), dvec3(surface.position(t.y)),
                                             dvec3(surface.position(t.z)));
      if (const double away = length(foot - p); away < best.distance) best = {foot, away, i};
    }
    return;
  }
  // Nearest first, so that the distance decreases early.
  std::array<std::pair<double, std::uint32_t>, kTreeWidth> near;
  std::size_t count = 0;
  const auto end = std::min<std::size_t>((at.box + 1) * kTreeWidth, boxes[at.level - 1].size());
  for (std::uint32_t c = at.box * kTreeWidth; c < end; ++c) {
    std::size_t place = count++;
    const double away = distance(boxes[at.level - 1][c], p);
    for (; place > 0 && near[place - 1].first > away; --place) near[place] = near[place - 1];
    near[place] = {away, c};
  }
  for (std::size_t i = 0; i < count; ++i)
    if (near[i].first < best.distance) find_closest(surface, p, {at.level - 1, near[i].second}, best);
}

}  // namespace

void find_hits(const Mesh& surface, dvec3 from, dvec3 along, std::vector<double>& shares) {
  cast(surface, from, along, 1.0, [&](std::uint32_t, double share) {
    shares.push_back(share);
    return false;
  });
}

RayHit first_hit(const Mesh& surface, dvec3 from, dvec3 along, double after) {
  RayHit first;
  cast(surface, from, along, first.share, [&](std::uint32_t triangle, double share) {
    if (share > after && share < first.share) first = {share, triangle};
    return false;
  });
  return first;
}

namespace {

// Spread evenly along a spiral; every run of them covers all sides. Unit vectors that no modelled surface is parallel
// to.
constexpr std::size_t kDirections = 40;
constexpr std::size_t kAgree = 8;  // if these agree, no more are tested
const std::array<dvec3, kDirections>& directions() {
  static const std::array<dvec3, kDirections> all = [] {
    std::array<dvec3, kDirections> made;
    constexpr double kGolden = std::numbers::pi * (3.0 - 2.2360679774997896);  // [rad] golden angle
    for (std::size_t i = 0; i < kDirections; ++i) {
      const std::size_t k = i * 17 % kDirections;
      const double z = 1.0 - (2.0 * static_cast<double>(k) + 1.0) / static_cast<double>(kDirections);
      const double r = std::sqrt(1.0 - z * z), angle = kGolden * static_cast<double>(k) + 0.1234;
      made[i] = {r * std::cos(angle), z, r * std::sin(angle)};
    }
    return made;
  }();
  return all;
}

struct Passage {
  double share;   // [m]: directions are unit vectors
  double facing;  // [1] cosine between direction and normal: below 0 it enters
};

bool through_odd_walls(const Mesh& surface, dvec3 p, dvec3 along, double thickest, std::vector<Passage>& passages) {
  passages.clear();
  constexpr double kFar = std::numeric_limits<double>::infinity();
  cast(surface, p, along, kFar, [&](std::uint32_t triangle, double share) {
    const uvec3 t = surface.triangles[triangle];
    const dvec3 a(surface.position(t.x));
    const dvec3 normal = cross(dvec3(surface.position(t.y)) - a, dvec3(surface.position(t.z)) - a);
    passages.push_back({share, dot(normal, along) / length(normal)});
    return false;
  });
  std::sort(passages.begin(), passages.end(), [](const Passage& a, const Passage& b) { return a.share < b.share; });
  bool odd = false;
  for (std::size_t i = 0; i + 1 < passages.size(); ++i) {
    const Passage &in = passages[i], &out = passages[i + 1];
    if (in.facing >= 0.0 || out.facing <= 0.0) continue;
    odd = odd != ((out.share - in.share) * std::min(-in.facing, out.facing) <= thickest);
    ++i;
  }
  return odd;
}

}  // namespace

double enclosed_share(const Mesh& surface, dvec3 p, double thickest) {
  std::vector<Passage> passages;
  std::size_t odd = 0, asked = 0;
  for (const dvec3& along : directions()) {
    odd += through_odd_walls(surface, p, along, thickest, passages);
    if (++asked == kAgree && (odd == 0 || odd == asked)) break;
  }
  return static_cast<double>(odd) / static_cast<double>(asked);
}

RayPoint closest_of(const Mesh& surface, dvec3 p, double reach) {
  RayPoint best;
  best.distance = reach;
  find_closest(surface, p, {static_cast<std::uint32_t>(surface.tree.levels.size() - 1), 0}, best);
  return best;
}

dvec3 closest_on_triangle(dvec3 p, dvec3 a, dvec3 b, dvec3 c) {
  const dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
               d6 = dot(ac, cp);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  if (d3 >= 0.0 && d4 <= d3) return b;
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + ab * (d1 / (d1 - d3));
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + ac * (d2 / (d2 - d6));
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  return a + ab * (vb / (va + vb + vc)) + ac * (vc / (va + vb + vc));
}

}  // namespace pliant
