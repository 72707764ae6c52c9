#include <algorithm>
#include <cmath>

#include "systems/soft/collide/meeting.h"

namespace pliant {
namespace {

constexpr double kSlack = 1e-6;  // [1] tolerance of barycentrics: no gap between triangles that share an edge
constexpr double kLean = 0.5;    // [1] largest distance of a foot beside the triangle, in gaps

// Barycentrics of the foot of p on the plane of the triangle with (unnormalised) normal n.
dvec3 barycentric_of(dvec3 p, dvec3 a, dvec3 b, dvec3 c, dvec3 n) {
  const double nn = dot(n, n);
  const double u = dot(cross(b - p, c - p), n) / nn;
  const double v = dot(cross(c - p, a - p), n) / nn;
  return {u, v, 1.0 - u - v};
}

dvec3 clamp_inside(dvec3 w) {
  w = glm::max(w, dvec3(0.0));
  return w / (w.x + w.y + w.z);
}

double smallest(dvec3 w) {
  return std::min({w.x, w.y, w.z});
}

// The point of segment ab nearest to p, as the share of b.
double along(dvec3 p, dvec3 a, dvec3 b) {
  const dvec3 e = b - a;
  const double ee = dot(e, e);
  return ee > 0.0 ? std::clamp(dot(p - a, e) / ee, 0.0, 1.0) : 0.0;
}

// Barycentrics of the triangle's point nearest to the foot, if the foot is at most `beside` [m] outside.
std::optional<dvec3> foot(dvec3 p, const std::array<dvec3, 3>& x, dvec3 n, double beside) {
  const dvec3 w = barycentric_of(p, x[0], x[1], x[2], n);
  if (smallest(w) >= -kSlack) return clamp_inside(w);
  if (beside <= 0.0) return {};
  const dvec3 at = w.x * x[0] + w.y * x[1] + w.z * x[2];
  double best = beside * beside;
  std::optional<dvec3> found;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (w[(i + 2) % 3] >= 0.0) continue;
    const double s = along(at, x[i], x[j]);
    const dvec3 off = x[i] + s * (x[j] - x[i]) - at;
    if (dot(off, off) > best) continue;
    best = dot(off, off);
    dvec3 on(0.0);
    on[i] = 1.0 - s;
    on[j] = s;
    found = on;
  }
  return found;
}

std::array<dvec3, 3> corners(const std::array<Moving, 3>& t, double time) {
  return {t[0].at(time), t[1].at(time), t[2].at(time)};
}
dvec3 normal_of(const std::array<dvec3, 3>& x) {
  return cross(x[1] - x[0], x[2] - x[0]);
}

}  // namespace

std::optional<Meeting> meet_triangle(const Moving& vertex, const std::array<Moving, 3>& triangle, const Reach& reach) {
  const std::array<dvec3, 3> x0 = corners(triangle, 0.0);
  const dvec3 n0 = normal_of(x0);
  const double area0 = length(n0);
  if (!(area0 > 0.0)) return {};
  Meeting m;
  m.normal = n0 / area0;
  m.gap = dot(m.normal, vertex.x - x0[0]);
  if (m.gap < -reach.behind) return {};
  const std::array<dvec3, 3> x1 = corners(triangle, 1.0);
  const dvec3 n1 = normal_of(x1), end = vertex.at(1.0);
  const double area1 = length(n1);
  m.end_gap = area1 > 0.0 ? dot(n1, end - x1[0]) / area1 : m.gap;

  // A vertex that travels less than the gap does not cross it.
  double travel = 0.0;
  for (const Moving& c : triangle) travel = std::max(travel, length(vertex.d - c.d));
  if (m.gap >= 0.0 && m.gap <= travel) {
    std::array<double, 3> times;
    const int count = find_crossings(triangle[0], triangle[1], triangle[2], vertex, times);
    for (int i = 0; i < count; ++i) {
      const std::array<dvec3, 3> x = corners(triangle, times[i]);
      const dvec3 n = normal_of(x);
      if (dot(n, n) == 0.0) continue;
      const dvec3 w = barycentric_of(vertex.at(times[i]), x[0], x[1], x[2], n);
      if (smallest(w) < -kSlack) continue;
      m.barycentric = clamp_inside(w);
      m.crosses = true;
      m.when = times[i];
      return m;
    }
  }
  if (m.gap <= reach.front) {
    if (const auto w = foot(vertex.x, x0, n0, kLean * std::abs(m.gap))) {
      m.barycentric = *w;
      return m;
    }
  }
  if (m.gap >= 0.0 && m.end_gap >= 0.0 && m.end_gap <= reach.front && area1 > 0.0) {
    if (const auto w = foot(end, x1, n1, kLean * m.end_gap)) {
      m.barycentric = *w;
      return m;
    }
  }
  return {};
}

}  // namespace pliant
