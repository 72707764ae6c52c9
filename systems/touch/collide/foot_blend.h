// Place and depth of a contact. Outside the surface, and away from convex creases, it is a single foot. A point behind
// a convex crease is below both sides. Its depth is then a smooth minimum of its depths below each side. The force
// therefore turns continuously from one side's normal to the other's, and fades where the point leaves through the
// other side. With depths s_i, smallest m:
//   ln s = min over weights of  sum w_i ln s_i + (D/2) (w.K w - 1),   w_i >= 0,  sum w_i = 1
//   => on the support  K w = c - ln s_i / D,   ds = s (sum w_i ds_i / s_i + (D/2) w.dK w)
// (sparsemax where K = 1; Martins & Astudillo 2016). It depends only on ratios of depths, and sides deeper than e^D m
// have no effect. It is continuously differentiable: the energy W(s) is conservative. K_ij = k(|n_i - n_j|), positive
// definite, is 1 for equal normals and 0 from 89 degrees on: two feet that are the same, or on one smooth side next to
// each other, count as one, and the depth is continuous where they merge.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "systems/touch/collide/foot.h"

namespace pliant {

inline constexpr std::uint32_t kMostFeet = 4;  // of one contact: a corner of a box has three
// D = ln 1.5: on a flat face the law is exact from 1.5 depths off the edge.
inline constexpr double kBlendRatio = 1.5;

struct FootBlend {
  std::uint32_t count = 0;  // 0: no place; foot[0] has the largest weight
  std::array<Foot, kMostFeet> foot;
  std::array<double, kMostFeet> weight{};
  std::array<dvec3, kMostFeet> weight_slope{};  // [1/m] d weight / dx

  double height = 0.0;    // [m] signed: minus the blended depth behind the surface
  dvec3 gradient{0};      // [1] d height / dx
  dvec3 p{0}, normal{0};  // [m], [1] blended place and unit normal
  dmat3 moves{0.0};       // [1] dp/dx
  dmat3 turns{0.0};       // [1/m] dn/dx

  const Foot& main() const { return foot[0]; }

  FootBlend() = default;
  FootBlend(const FootBlend& other) noexcept { *this = other; }
  // Without the feet that are not there: mostly there is one.
  FootBlend& operator=(const FootBlend& other) noexcept {
    count = other.count;
    std::copy_n(other.foot.begin(), std::max(count, 1u), foot.begin());
    weight = other.weight;
    weight_slope = other.weight_slope;
    height = other.height;
    gradient = other.gradient;
    p = other.p;
    normal = other.normal;
    moves = other.moves;
    turns = other.turns;
    return *this;
  }
};

// The place of one foot.
FootBlend place_of(const Foot& foot);

// A value painted per vertex, at the blended place: value and gradient by x. Nothing painted: value 1, gradient 0.
struct Painted {
  double value = 1.0;  // [1] or the unit of what is interpolated
  dvec3 gradient{0};   // per metre
};
template <class Of>
Painted interpolate(const FootBlend& blend, const Mesh& mesh, Of of) {
  Painted sum{0.0, dvec3(0)};
  for (std::uint32_t f = 0; f < blend.count; ++f) {
    const Foot& foot = blend.foot[f];
    const uvec3 t = mesh.triangles[foot.triangle];
    double value = 0.0;
    dvec3 gradient(0);
    for (int i = 0; i < 3; ++i) {
      const double at = of(t[i]);
      value += foot.barycentric[i] * at;
      gradient += at * foot.shifts[static_cast<std::size_t>(i)];
    }
    sum.value += blend.weight[f] * value;
    sum.gradient += blend.weight[f] * gradient + value * blend.weight_slope[f];
  }
  return sum;
}
inline Painted painted(const FootBlend& blend, const Mesh& mesh, const std::vector<float>& factor) {
  if (factor.empty()) return {};
  return interpolate(blend, mesh, [&](std::uint32_t v) { return double(factor[v]); });
}

// cos of the angle at which x is seen from the side's edge, if its foot is there. The depth below that side is s / cos:
// the side has no effect where x leaves its tangent plane.
struct Facing {
  double cosine = 1.0;
  dvec3 slope{0};  // [1/m] d cosine / dx
};

// Blends `feet`. The first is the contact's foot. All are behind the surface, or there is only one.
FootBlend blend_feet(const std::array<Foot, kMostFeet>& feet, std::uint32_t count,
                     const std::array<Facing, kMostFeet>& facing = {});

}  // namespace pliant
