// Times at which four moving points become coplanar: a cubic in time.
#include <algorithm>
#include <cmath>

#include "systems/soft/collide/meeting.h"

namespace pliant {
namespace {

using TimeCubic = std::array<double, 4>;  // c0 + c1 t + c2 t2 + c3 t3

double value(const TimeCubic& c, double t) {
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

// In Bernstein form over [0, 1] a polynomial stays within its coefficients: if all are positive, it has no root.
bool stays_positive(const TimeCubic& c) {
  return c[0] > 0.0 && c[0] + c[1] / 3.0 > 0.0 && c[0] + (2.0 * c[1] + c[2]) / 3.0 > 0.0 &&
         c[0] + c[1] + c[2] + c[3] > 0.0;
}

// Extrema inside (0, 1): c1 + 2 c2 t + 3 c3 t2 = 0.
int turning_points(const TimeCubic& c, std::array<double, 2>& t) {
  const double qa = 3.0 * c[3], qb = c[2], qc = c[1];
  int count = 0;
  const auto keep = [&](double x) {
    if (x > 0.0 && x < 1.0) t[count++] = x;
  };
  const double disc = qb * qb - qa * qc;
  if (disc <= 0.0) return 0;
  const double s = -(qb + std::copysign(std::sqrt(disc), qb));
  if (qa != 0.0) keep(s / qa);
  if (s != 0.0) keep(qc / s);
  if (count == 2 && t[0] > t[1]) std::swap(t[0], t[1]);
  return count;
}

// The root in a falling interval: regula falsi in its Illinois form, which converges at once for simple motion.
double root(const TimeCubic& c, double lo, double hi) {
  double at_lo = value(c, lo), at_hi = value(c, hi);
  const double enough = 1e-14 * (at_lo - at_hi);
  int side = 0;
  double t = hi;
  for (int i = 0; i < 60; ++i) {
    t = std::clamp((lo * at_hi - hi * at_lo) / (at_hi - at_lo), lo, hi);
    const double at = value(c, t);
    if (std::abs(at) <= enough) break;
    if (at > 0.0) {
      lo = t, at_lo = at;
      if (side == 1) at_hi *= 0.5;
      side = 1;
    } else {
      hi = t, at_hi = at;
      if (side == -1) at_lo *= 0.5;
      side = -1;
    }
  }
  return t;
}

}  // namespace

int find_crossings(const Moving& a, const Moving& p, const Moving& q, const Moving& r, std::array<double, 3>& times) {
  const dvec3 e = p.x - a.x, f = q.x - a.x, g = r.x - a.x;
  const dvec3 E = p.d - a.d, F = q.d - a.d, G = r.d - a.d;
  const dvec3 n0 = cross(e, f), n1 = cross(E, f) + cross(e, F), n2 = cross(E, F);
  const TimeCubic c{dot(n0, g), dot(n0, G) + dot(n1, g), dot(n1, G) + dot(n2, g), dot(n2, G)};
  if (stays_positive(c)) return 0;
  std::array<double, 2> turns{};
  const int turn_count = turning_points(c, turns);
  int count = 0;
  double lo = 0.0;
  for (int i = 0; i <= turn_count; ++i) {
    const double hi = i < turn_count ? turns[i] : 1.0;
    if (value(c, lo) >= 0.0 && value(c, hi) < 0.0) times[count++] = root(c, lo, hi);
    lo = hi;
  }
  return count;
}

}  // namespace pliant
