// A region that pushes out: U = k d^2 / 2, d the depth below the surface where the tip came in, as a god-object's.
// Regions grow by the tip's radius.
//
// A box keeps the face through which the tip came: beyond its middle it still pushes back. A sphere pushes along its
// radius; a tip that is pushed through the middle is pulled back to where it came in. So a tip is held up to a force of
// k times the way through the region. Beyond it U falls to zero: energy is lost. Towards the four other faces of a box
// U fades out (Fade), so that a tip that leaves there slides off by a continuous force and gets its energy back. A tip
// that begins inside is pushed only beyond its first depth.
#include <algorithm>
#include <cmath>

#include "systems/effects/effect_law.h"

namespace pliant {
namespace {

// Factor of U near a side: the smooth step S of t = s / e, s the distance to the side. e = d h / (d + h) is
// nearly the depth d, and below h, so that the middle of the region has all of U. Derivatives by d and s.
struct Fade {
  double value = 1.0, by_d = 0.0, by_s = 0.0, by_dd = 0.0, by_ds = 0.0, by_ss = 0.0;
};
Fade fade(double s, double d, double h) {
  Fade out;
  if (!(d > 0.0) || !(h > 0.0)) return out;
  const double sum = d + h, e = d * h / sum, e1 = h * h / (sum * sum), e2 = -2.0 * e1 / sum, t = s / e;
  if (!(t < 1.0)) return out;
  const double u = std::max(0.0, t), slope = 6.0 * u * (1.0 - u), curvature = 6.0 - 12.0 * u;
  const double t_d = -u * e1 / e, t_s = 1.0 / e, t_dd = u * (2.0 * e1 * e1 / (e * e) - e2 / e), t_ds = -e1 / (e * e);
  out.value = u * u * (3.0 - 2.0 * u);
  out.by_d = slope * t_d;
  out.by_s = slope * t_s;
  out.by_dd = curvature * t_d * t_d + slope * t_dd;
  out.by_ds = curvature * t_d * t_s + slope * t_ds;
  out.by_ss = curvature * t_s * t_s;
  return out;
}

// [m] The depth that pushes.
double pushed(EffectMemory& memory, double depth) {
  if (!memory.inside) memory.unpushed = memory.begun ? 0.0 : depth;
  memory.inside = true;
  memory.unpushed = std::min(memory.unpushed, depth);
  return depth - memory.unpushed;
}

// `turns`: d normal / dx, of the direction to the surface.
EffectValue penalty(const EffectInput& in, EffectMemory& memory, double depth, dvec3 normal, const dmat3& turns) {
  const double k = in.effect.stiffness, d = pushed(memory, depth);
  EffectValue out;
  out.energy = 0.5 * k * d * d;
  out.force = k * d * normal;
  if (d > 0.0) out.stiffness = k * glm::outerProduct(normal, normal) - k * d * turns;
  return out;
}

// Face through which the tip came, or the nearest one: an axis with its sign.
dvec3 face_of(dvec3 half, dvec3 from, dvec3 to, bool came) {
  int axis = -1;
  double latest = -1.0, least = 0.0, sign = 1.0;
  for (int i = 0; came && i < 3; ++i) {
    if (!(std::abs(from[i]) >= half[i])) continue;
    const double s = std::copysign(1.0, from[i]), at = (s * half[i] - from[i]) / (to[i] - from[i]);
    if (at > latest) latest = at, axis = i, sign = s;
  }
  for (int i = 0; latest < 0.0 && i < 3; ++i) {
    const double depth = half[i] - std::abs(to[i]);
    if (axis < 0 || depth < least) least = depth, axis = i, sign = std::copysign(1.0, to[i]);
  }
  dvec3 out(0);
  out[axis] = sign;
  return out;
}

EffectValue outside(EffectMemory& memory) {
  memory.inside = false;
  memory.unpushed = 0.0;
  return {};
}

EffectValue out_of_box(const EffectInput& in, EffectMemory& memory) {
  const dvec3 low = in.effect.box.min, high = in.effect.box.max;
  const dvec3 middle = 0.5 * (low + high), half = 0.5 * (high - low) + dvec3(in.radius), x = in.x - middle;
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(x[i]) < half[i])) return outside(memory);
  if (!memory.inside) memory.side = face_of(half, in.before - middle, x, memory.begun);
  const double d = pushed(memory, dot(half, glm::abs(memory.side)) - dot(x, memory.side)), k = in.effect.stiffness;
  EffectValue out;
  if (!(d > 0.0)) return out;
  // U = k d^2 / 2 times the fades of the sides; `to` of an axis: d (d or s) / dx.
  int axis = 0;
  while (memory.side[axis] == 0.0) ++axis;
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Fade a = fade(half[i] - std::abs(x[i]), d, 0.5 * half[i]), b = fade(half[j] - std::abs(x[j]), d, 0.5 * half[j]);
  const double whole = 0.5 * k * d * d, both = a.value * b.value;
  const double by_d = a.by_d * b.value + a.value * b.by_d;
  dvec3 to(0), slope(0);
  for (const int each : {i, j}) to[each] = -std::copysign(1.0, x[each]);
  to[axis] = -memory.side[axis];
  slope[axis] = k * d * both + whole * by_d;
  slope[i] = whole * a.by_s * b.value;
  slope[j] = whole * a.value * b.by_s;
  dmat3 bends(0.0);
  bends[axis][axis] =
      k * both + 2.0 * k * d * by_d + whole * (a.by_dd * b.value + 2.0 * a.by_d * b.by_d + a.value * b.by_dd);
  bends[i][i] = whole * a.by_ss * b.value;
  bends[j][j] = whole * a.value * b.by_ss;
  bends[i][j] = bends[j][i] = whole * a.by_s * b.by_s;
  bends[axis][i] = bends[i][axis] = k * d * a.by_s * b.value + whole * (a.by_ds * b.value + a.by_s * b.by_d);
  bends[axis][j] = bends[j][axis] = k * d * a.value * b.by_s + whole * (a.value * b.by_ds + a.by_d * b.by_s);
  out.energy = whole * both;
  out.force = -to * slope;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out.stiffness[c][r] = to[r] * to[c] * bends[c][r];
  return out;
}

EffectValue out_of_sphere(const EffectInput& in, EffectMemory& memory) {
  const double radius = in.effect.radius + in.radius, r = length(in.x);
  if (!(r < radius)) return outside(memory);
  if (!memory.inside) {
    const dvec3 from = memory.begun ? in.before : in.x;
    memory.side = length(from) > 0.0 ? normalize(from) : dvec3(0, 1, 0);
  }
  if (dot(in.x, memory.side) > 0.0) {
    memory.side = in.x / r;
    return penalty(in, memory, radius - r, memory.side, (dmat3(1.0) - glm::outerProduct(memory.side, memory.side)) / r);
  }
  const dvec3 back = radius * memory.side - in.x;
  const double depth = length(back);
  const dvec3 normal = back / depth;
  return penalty(in, memory, depth, normal, (glm::outerProduct(normal, normal) - dmat3(1.0)) / depth);
}

}  // namespace

EffectValue effect_forbidden(const EffectInput& in, EffectMemory& memory) {
  if (in.effect.region == EffectRegion::kBox) return out_of_box(in, memory);
  if (in.effect.region == EffectRegion::kSphere) return out_of_sphere(in, memory);
  const double depth = in.radius - in.x.y;
  if (in.effect.region == EffectRegion::kEverywhere || !(depth > 0.0)) return outside(memory);
  return penalty(in, memory, depth, dvec3(0, 1, 0), dmat3(0.0));
}

}  // namespace pliant
