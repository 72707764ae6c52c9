#include "content/author/solid.h"

namespace pliant::solids {
namespace {

constexpr double kDifference = 1e-6;  // [m] step of the finite difference for gradients; the shapes vary over
                                      // millimetres

dvec3 gradient(const Solid& solid, dvec3 p) {
  dvec3 g;
  for (int i = 0; i < 3; ++i) {
    dvec3 step(0);
    step[i] = kDifference;
    g[i] = (solid(p + step) - solid(p - step)) / (2.0 * kDifference);
  }
  return g;
}

}  // namespace

dvec3 normal_at(const Solid& solid, dvec3 p) {
  return normalize(gradient(solid, p));
}

dvec3 project(const Solid& solid, dvec3 p) {
  for (int i = 0; i < 12; ++i) {
    const dvec3 g = gradient(solid, p);
    dvec3 step = g * (-solid(p) / dot(g, g));
    const double l = length(step);
    if (l > 0.01) step *= 0.01 / l;  // far from the surface the gradient is unreliable
    p += step;
    if (l < 1e-10) break;
  }
  return p;
}

}  // namespace pliant::solids
