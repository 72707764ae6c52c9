#include "systems/effects/effect_law.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// Smooth step 3 t^2 - 2 t^3 of the depth t, in units of the edge.
struct Step {
  double value, slope, curvature;
};
Step smooth_step(double t) {
  if (t <= 0.0) return {0.0, 0.0, 0.0};
  if (t >= 1.0) return {1.0, 0.0, 0.0};
  return {t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t), 6.0 - 12.0 * t};
}

RegionWeight weight_in_sphere(const Effect& effect, dvec3 x) {
  const double r = length(x), edge = std::min(effect.edge, effect.radius);
  const Step s = smooth_step((effect.radius - r) / edge);
  RegionWeight out{s.value, dvec3(0), dmat3(0.0)};
  if (s.slope == 0.0 && s.curvature == 0.0) return out;
  const dvec3 n = x / r;
  const dmat3 along = glm::outerProduct(n, n);
  out.slope = -s.slope / edge * n;
  out.curvature = s.curvature / (edge * edge) * along - s.slope / (edge * r) * (dmat3(1.0) - along);
  return out;
}

RegionWeight weight_in_box(const Effect& effect, dvec3 x) {
  const dvec3 middle = 0.5 * (effect.box.min + effect.box.max);
  const dvec3 half = 0.5 * (effect.box.max - effect.box.min);
  double value[3], slope[3], curvature[3];
  for (int i = 0; i < 3; ++i) {
    const double edge = std::min(effect.edge, half[i]), away = x[i] - middle[i];
    const Step s = edge > 0.0 ? smooth_step((half[i] - std::abs(away)) / edge) : Step{0.0, 0.0, 0.0};
    value[i] = s.value;
    slope[i] = s.slope == 0.0 ? 0.0 : -std::copysign(s.slope / edge, away);
    curvature[i] = s.curvature == 0.0 ? 0.0 : s.curvature / (edge * edge);
  }
  RegionWeight out{value[0] * value[1] * value[2], dvec3(0), dmat3(0.0)};
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    out.slope[i] = slope[i] * value[j] * value[k];
    out.curvature[i][i] = curvature[i] * value[j] * value[k];
    out.curvature[i][j] = out.curvature[j][i] = slope[i] * slope[j] * value[k];
  }
  return out;
}

}  // namespace

RegionWeight region_weight(const Effect& effect, dvec3 x) {
  switch (effect.region) {
    case EffectRegion::kEverywhere:
      return {1.0, dvec3(0), dmat3(0.0)};
    case EffectRegion::kSphere:
      return weight_in_sphere(effect, x);
    case EffectRegion::kBox:
      return weight_in_box(effect, x);
    case EffectRegion::kHalfSpace:
      break;
  }
  const Step s = smooth_step(-x.y / effect.edge);
  RegionWeight out{s.value, {0, -s.slope / effect.edge, 0}, dmat3(0.0)};
  out.curvature[1][1] = s.curvature / (effect.edge * effect.edge);
  return out;
}

EffectValue weighted(const EffectValue& value, const RegionWeight& weight) {
  EffectValue out;
  out.energy = weight.value * value.energy;
  out.force = weight.value * value.force - value.energy * weight.slope;
  out.stiffness = weight.value * value.stiffness + value.energy * weight.curvature -
                  glm::outerProduct(value.force, weight.slope) - glm::outerProduct(weight.slope, value.force);
  return out;
}

EffectValue well(const Effect& effect, dvec3 v, const dmat3& moves) {
  const double k = effect.stiffness, r2 = effect.range * effect.range, q = dot(v, v) / r2, rest = 1.0 - q;
  EffectValue out;
  out.energy = k * r2 / 6.0;
  if (!(q < 1.0)) return out;
  out.energy *= q * (3.0 - q * (3.0 - q));
  out.force = -k * rest * rest * v;
  out.stiffness = k * rest * rest * moves - 4.0 * k * rest / r2 * glm::outerProduct(v, v);
  return out;
}

}  // namespace pliant
