#include <algorithm>
#include <cmath>

#include "systems/soft/collide/meeting.h"

namespace pliant {
namespace {

constexpr double kParallel = 1e-2;   // [1] sine below which the common normal of two edges is undefined
constexpr double kLeaning = 0.05;    // [1] sine by which a triangle may lean over its edge
constexpr double kEdgeSlack = 1e-6;  // [1] beyond the ends

struct Feet {
  double a, b;  // [1] along either edge
};
// Feet of the common perpendicular of two non-parallel lines.
std::optional<Feet> feet(dvec3 a0, dvec3 a1, dvec3 b0, dvec3 b1) {
  const dvec3 e = a1 - a0, f = b1 - b0, r = a0 - b0;
  const double ee = dot(e, e), ff = dot(f, f), ef = dot(e, f), er = dot(e, r), fr = dot(f, r);
  const double det = ee * ff - ef * ef;
  if (!(det > 0.0)) return {};
  const Feet s{(ef * fr - er * ff) / det, (ee * fr - ef * er) / det};
  const double lo = -kEdgeSlack, hi = 1.0 + kEdgeSlack;
  if (s.a < lo || s.a > hi || s.b < lo || s.b > hi) return {};
  return Feet{std::clamp(s.a, 0.0, 1.0), std::clamp(s.b, 0.0, 1.0)};
}

bool leans_over(const EdgeShape& shape, dvec3 outward, double time) {
  const auto leans = [&](int i) { return dot(shape.inward[i] + time * shape.turning[i], outward) > kLeaning; };
  return leans(0) || leans(1);
}

}  // namespace

std::optional<Meeting> meet_edge(const std::array<Moving, 2>& a, const EdgeShape& shape_a,
                                 const std::array<Moving, 2>& b, const EdgeShape& shape_b, const Reach& reach) {
  const dvec3 e = a[1].x - a[0].x, f = b[1].x - b[0].x;
  dvec3 n = cross(e, f);
  const double nn = dot(n, n);
  if (!(nn > kParallel * kParallel * dot(e, e) * dot(f, f))) return {};
  n /= std::sqrt(nn);
  const bool turned = dot(n, shape_b.outward - shape_a.outward) < 0.0;
  Meeting m;
  m.normal = turned ? -n : n;
  m.gap = dot(m.normal, a[0].x - b[0].x);
  const auto lean = [&](dvec3 normal, double time) {
    return leans_over(shape_a, -normal, time) || leans_over(shape_b, normal, time);
  };
  const bool leaning = lean(m.normal, 0.0);
  if (m.gap < -reach.behind || (leaning && m.gap < 0.0)) return {};

  const std::array<dvec3, 2> a1{a[0].at(1.0), a[1].at(1.0)}, b1{b[0].at(1.0), b[1].at(1.0)};
  const dvec3 n1 = cross(a1[1] - a1[0], b1[1] - b1[0]) * (turned ? -1.0 : 1.0);
  const double l1 = length(n1);
  m.end_gap = l1 > 0.0 ? dot(n1, a1[0] - b1[0]) / l1 : m.gap;
  const auto accept = [&](const std::optional<Feet>& s) {
    if (!s) return false;
    m.along_a = s->a;
    m.along_b = s->b;
    return true;
  };
  if (m.gap >= 0.0) {
    std::array<double, 3> times;
    const Moving& b_first = turned ? b[1] : b[0];
    const Moving& b_last = turned ? b[0] : b[1];
    // Points b, b + f, b + (a0 - b), b + (a1 - b): the volume is (f x (a0 - b)) . (a1 - b) = (e x f) . (a0 - b).
    const int count = find_crossings(b_first, b_last, a[0], a[1], times);
    for (int i = 0; i < count; ++i) {
      const double t = times[i];
      const std::array<dvec3, 2> at{a[0].at(t), a[1].at(t)}, bt{b[0].at(t), b[1].at(t)};
      if (!accept(feet(at[0], at[1], bt[0], bt[1]))) continue;
      if (leaning) {
        const dvec3 normal = cross(at[1] - at[0], bt[1] - bt[0]) * (turned ? -1.0 : 1.0);
        const double size = length(normal);
        if (!(size > 0.0) || lean(normal / size, t)) continue;
      }
      m.crosses = true;
      m.when = t;
      return m;
    }
  }
  if (leaning) return {};
  if (m.gap <= reach.front && accept(feet(a[0].x, a[1].x, b[0].x, b[1].x))) return m;
  if (m.gap >= 0.0 && m.end_gap >= 0.0 && m.end_gap <= reach.front && accept(feet(a1[0], a1[1], b1[0], b1[1])))
    return m;
  return {};
}

}  // namespace pliant
