// A region that pushes out: U = k d^2 / 2, d the depth below the surface where the tip came in, as a god-object's.
// Regions grow by the tip's radius.
//
// A box keeps the face through which the tip came: beyond its middle it still pushes back. A sphere pushes along its
// radius; a tip that is pushed through the middle is pulled back to where it came in. So a tip is held up to a force of
// k times the way through the region. Beyond it, or where the tip leaves by another face, U falls to zero: energy is
// lost. A tip that begins inside is pushed only beyond its first depth.
#include <algorithm>
#include <cmath>

#include "systems/effects/effect_law.h"

namespace pliant {
namespace {

// `turns`: d normal / dx, of the direction to the surface.
EffectValue penalty(const EffectInput& in, EffectMemory& memory, double depth, dvec3 normal, const dmat3& turns) {
  if (!memory.inside) memory.unpushed = memory.begun ? 0.0 : depth;
  memory.inside = true;
  memory.unpushed = std::min(memory.unpushed, depth);
  const double k = in.effect.stiffness, d = depth - memory.unpushed;
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
  const dvec3 low(in.effect.box.min), high(in.effect.box.max);
  const dvec3 middle = 0.5 * (low + high), half = 0.5 * (high - low) + dvec3(in.radius), x = in.x - middle;
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(x[i]) < half[i])) return outside(memory);
  if (!memory.inside) memory.side = face_of(half, in.before - middle, x, memory.begun);
  return penalty(in, memory, dot(half, glm::abs(memory.side)) - dot(x, memory.side), memory.side, dmat3(0.0));
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
