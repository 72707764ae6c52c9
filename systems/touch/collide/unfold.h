// One step of a march over a surface: the distance of a triangle's third corner from those of the other two, with the
// source unfolded into the triangle's plane. Exact on flat and developable surfaces (surface_distance.h).
#pragma once

#include <algorithm>
#include <cmath>

#include "components/math.h"

namespace pliant {

struct Arrival {
  float distance;  // [m]
  vec3 direction;  // unit, in the triangle's plane
};

// Arrival at the third corner v of a triangle whose corners a and b have distances ra and rb.
inline Arrival arrive(vec3 a, vec3 b, vec3 v, float ra, float rb) {
  const vec3 ab = b - a, av = v - a, bv = v - b;
  const float L = length(ab);
  const vec3 ex = ab / std::max(L, 1e-30f);
  const float vx = dot(av, ex);
  const vec3 up = av - vx * ex;
  const float vy = length(up);
  if (L > 0 && vy > 0) {
    const float sx = (ra * ra - rb * rb + L * L) / (2 * L);
    const float sy = std::sqrt(std::max(0.0f, ra * ra - sx * sx));  // S = (sx, -sy), on the far side of the edge
    const float crossing = sx + (vx - sx) * sy / (vy + sy);         // where S-v meets the edge
    if (crossing >= 0 && crossing <= L) {
      const float dx = vx - sx, dy = vy + sy, r = std::sqrt(dx * dx + dy * dy);
      return {r, (dx * ex + dy * (up / vy)) / std::max(r, 1e-30f)};
    }
  }
  // The path bends at a corner.
  const float la = length(av), lb = length(bv);
  if (ra + la <= rb + lb) return {ra + la, av / std::max(la, 1e-30f)};
  return {rb + lb, bv / std::max(lb, 1e-30f)};
}

}  // namespace pliant
