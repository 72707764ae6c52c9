#include "systems/touch/collide/foot_blend.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// Weights of the smooth minimum of ln s, and its value.
struct Weights {
  std::array<double, kMostFeet> w{};
  double value = 0.0;  // [1] ln s
};
Weights smooth_minimum(const std::array<double, kMostFeet>& log_depth, std::uint32_t count, double D) {
  std::array<double, kMostFeet> sorted = log_depth;
  std::sort(sorted.begin(), sorted.begin() + count);
  // The support grows while the next depth is below the level c at which the weights sum to one.
  double sum = 0.0, c = 0.0;
  for (std::uint32_t n = 0; n < count; ++n) {
    if (n > 0 && sorted[n] >= c) break;
    sum += sorted[n];
    c = (D + sum) / (n + 1);
  }
  Weights result;
  double squares = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double w = std::max(0.0, (c - log_depth[i]) / D);
    result.w[i] = w;
    result.value += w * log_depth[i];
    squares += w * w;
  }
  result.value += 0.5 * D * (squares - 1.0);
  return result;
}

FootBlend alone(const Foot& foot) {
  FootBlend blend;
  blend.count = 1;
  blend.foot[0] = foot;
  blend.weight[0] = 1.0;
  blend.height = foot.height;
  blend.gradient = blend.normal = foot.normal;
  blend.p = foot.p;
  blend.moves = foot.moves;
  blend.turns = foot.turns;
  return blend;
}

}  // namespace

FootBlend blend_feet(const std::array<Foot, kMostFeet>& feet, std::uint32_t count) {
  if (count <= 1 || feet[0].height >= 0) return alone(feet[0]);
  const double D = std::log(kBlendRatio);
  std::array<double, kMostFeet> log_depth{};
  for (std::uint32_t i = 0; i < count; ++i) log_depth[i] = std::log(-feet[i].height);
  const Weights weights = smooth_minimum(log_depth, count, D);

  FootBlend blend;
  dvec3 mean_slope(0);  // of ln s over the support
  std::uint32_t main = 0;
  std::array<dvec3, kMostFeet> slope{};
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!(weights.w[i] > 0)) continue;
    if (weights.w[i] > blend.weight[main]) main = blend.count;
    slope[blend.count] = feet[i].normal / feet[i].height;  // d ln(-height) = n . dx / height
    mean_slope += slope[blend.count];
    blend.weight[blend.count] = weights.w[i];
    blend.foot[blend.count++] = feet[i];
  }
  if (blend.count == 1) return alone(blend.foot[0]);
  mean_slope /= static_cast<double>(blend.count);
  const double depth = std::exp(weights.value);
  blend.height = -depth;
  dvec3 n(0);
  dmat3 dn(0.0);
  for (std::uint32_t i = 0; i < blend.count; ++i) {
    const Foot& foot = blend.foot[i];
    const double w = blend.weight[i];
    const dvec3 dw = (mean_slope - slope[i]) / D;
    blend.weight_slope[i] = dw;
    blend.gradient -= depth * w * slope[i];
    blend.p += w * foot.p;
    blend.moves += w * foot.moves + glm::outerProduct(foot.p, dw);
    n += w * foot.normal;
    dn += w * foot.turns + glm::outerProduct(foot.normal, dw);
  }
  const double size = length(n);
  if (size > 1e-9) {
    blend.normal = n / size;
    blend.turns = (dmat3(1.0) - glm::outerProduct(blend.normal, blend.normal)) * dn / size;
  } else {
    blend.normal = blend.foot[main].normal;
  }
  if (main != 0) {
    std::swap(blend.foot[0], blend.foot[main]);
    std::swap(blend.weight[0], blend.weight[main]);
    std::swap(blend.weight_slope[0], blend.weight_slope[main]);
  }
  return blend;
}

}  // namespace pliant
