#include "systems/touch/collide/foot_blend.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace pliant {
namespace {

// Chord of two normals from which on their sides are wholly apart: just below that of a right angle. [1]
constexpr double kUnlike = 1.4;
// Added to K's diagonal: feet that are the same share the weight evenly. [1]
constexpr double kSameWeight = 1e-9;

using BlendRow = std::array<double, kMostFeet>;

// K of two normals: Wendland's C2 function of their chord, which is positive definite in space. And dK/d(n_i . n_j).
struct Likeness {
  double value, slope;
};
Likeness likeness(dvec3 a, dvec3 b) {
  const dvec3 d = a - b;
  const double q2 = dot(d, d) / (kUnlike * kUnlike);
  if (!(q2 < 1)) return {0.0, 0.0};
  const double q = std::sqrt(q2), w = 1 - q;
  return {w * w * w * w * (4 * q + 1), 20 * w * w * w / (kUnlike * kUnlike)};
}

// The feet of a blend, by ln s.
struct BlendSides {
  std::uint32_t count = 0;
  BlendRow log_depth{};
  std::array<BlendRow, kMostFeet> K{};
};

// Solves K x = b over the feet of `on` by Cholesky.
struct BlendFactor {
  std::uint32_t count = 0;
  std::array<std::uint32_t, kMostFeet> at{};
  std::array<BlendRow, kMostFeet> L{};

  BlendFactor(const BlendSides& sides, unsigned on) {
    for (std::uint32_t i = 0; i < sides.count; ++i)
      if (on >> i & 1) at[count++] = i;
    for (std::uint32_t i = 0; i < count; ++i)
      for (std::uint32_t j = 0; j <= i; ++j) {
        double sum = sides.K[at[i]][at[j]];
        for (std::uint32_t k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
        L[i][j] = i == j ? std::sqrt(std::max(sum, kSameWeight)) : sum / L[j][j];
      }
  }
  // b, x by position in `at`.
  template <class T>
  std::array<T, kMostFeet> solve(std::array<T, kMostFeet> b) const {
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t k = 0; k < i; ++k) b[i] -= L[i][k] * b[k];
      b[i] *= 1 / L[i][i];
    }
    for (std::uint32_t i = count; i-- > 0;) {
      for (std::uint32_t k = i + 1; k < count; ++k) b[i] -= L[k][i] * b[k];
      b[i] *= 1 / L[i][i];
    }
    return b;
  }
};

// Weights of the smooth minimum: on a support K w = c - ln s / D, sum w = 1. Beyond it no foot would lower the value.
BlendRow weights_of(const BlendSides& sides, double D) {
  BlendRow best{};
  const auto least = std::min_element(sides.log_depth.begin(), sides.log_depth.begin() + sides.count);
  best[static_cast<std::size_t>(least - sides.log_depth.begin())] = 1.0;
  for (unsigned on = (1u << sides.count) - 1; on > 0; --on) {
    if ((on & (on - 1)) == 0 && !(*least == sides.log_depth[static_cast<std::size_t>(std::countr_zero(on))])) continue;
    const BlendFactor factor(sides, on);
    BlendRow one{}, depths{};
    for (std::uint32_t i = 0; i < factor.count; ++i) {
      one[i] = 1.0;
      depths[i] = sides.log_depth[factor.at[i]] / D;
    }
    const BlendRow a = factor.solve(one), b = factor.solve(depths);
    double ones = 0.0, sum = 0.0;
    for (std::uint32_t i = 0; i < factor.count; ++i) {
      ones += a[i];
      sum += b[i];
    }
    const double c = (1 + sum) / ones;
    BlendRow w{};
    bool minimum = true;
    for (std::uint32_t i = 0; i < factor.count; ++i) {
      w[factor.at[i]] = c * a[i] - b[i];
      minimum = minimum && w[factor.at[i]] > 0;
    }
    for (std::uint32_t j = 0; minimum && j < sides.count; ++j) {
      if (on >> j & 1) continue;
      double at = sides.log_depth[j] / D;
      for (std::uint32_t i = 0; i < sides.count; ++i) at += sides.K[j][i] * w[i];
      minimum = at >= c - 1e-12;
    }
    if (minimum) return w;
  }
  return best;
}

}  // namespace

FootBlend place_of(const Foot& foot) {
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

FootBlend blend_feet(const std::array<Foot, kMostFeet>& feet, std::uint32_t count,
                     const std::array<Facing, kMostFeet>& facing) {
  if (count <= 1 || feet[0].height >= 0) return place_of(feet[0]);
  const double D = std::log(kBlendRatio);
  BlendSides sides;
  sides.count = count;
  for (std::uint32_t i = 0; i < count; ++i) {
    sides.log_depth[i] = std::log(-feet[i].height / facing[i].cosine);
    for (std::uint32_t j = 0; j < i; ++j)
      sides.K[i][j] = sides.K[j][i] = likeness(feet[i].normal, feet[j].normal).value;
    sides.K[i][i] = 1.0 + kSameWeight;
  }
  const BlendRow weights = weights_of(sides, D);

  FootBlend blend;
  double value = 0.0, squares = 0.0;
  std::uint32_t main = 0;
  unsigned on = 0;
  std::array<dvec3, kMostFeet> slope{};
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!(weights[i] > 0)) continue;
    if (weights[i] > blend.weight[main]) main = blend.count;
    on |= 1u << i;
    value += weights[i] * sides.log_depth[i];
    for (std::uint32_t j = 0; j < count; ++j) squares += weights[i] * weights[j] * sides.K[i][j];
    slope[blend.count] = feet[i].normal / feet[i].height - facing[i].slope / facing[i].cosine;
    blend.weight[blend.count] = weights[i];
    blend.foot[blend.count++] = feet[i];
  }
  if (on == 1u) return place_of(feet[0]);
  // sum_j w_j dK_ij, and the weights' slopes: K dw = dc - d ln s / D - dK w, sum dw = 0.
  std::array<dvec3, kMostFeet> turned{}, by{}, ones{};
  for (std::uint32_t i = 0; i < blend.count; ++i) {
    for (std::uint32_t j = 0; j < blend.count; ++j) {
      if (j == i) continue;
      const Foot &a = blend.foot[i], &b = blend.foot[j];
      turned[i] += blend.weight[j] * likeness(a.normal, b.normal).slope *
                   (glm::transpose(a.turns) * b.normal + glm::transpose(b.turns) * a.normal);
    }
    by[i] = -slope[i] / D - turned[i];
    ones[i] = dvec3(1);
  }
  const BlendFactor factor(sides, on);
  by = factor.solve(by);
  ones = factor.solve(ones);
  dvec3 sum(0);
  double whole = 0.0;
  for (std::uint32_t i = 0; i < blend.count; ++i) {
    sum += by[i];
    whole += ones[i].x;
  }
  const double depth = std::exp(value + 0.5 * D * (squares - 1.0 - kSameWeight));
  blend.height = -depth;
  dvec3 n(0);
  dmat3 dn(0.0);
  for (std::uint32_t i = 0; i < blend.count; ++i) {
    const Foot& foot = blend.foot[i];
    const double w = blend.weight[i];
    const dvec3 dw = by[i] - ones[i].x / whole * sum;
    blend.weight_slope[i] = dw;
    blend.gradient -= depth * w * (slope[i] + 0.5 * D * turned[i]);
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
