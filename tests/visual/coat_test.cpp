#include "systems/visual/coat.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pliant {
namespace {

// The same integral over all directions of light on a fine grid, without importance sampling.
dvec2 by_quadrature(double n_v, double roughness) {
  const double alpha = roughness * roughness, a2 = alpha * alpha;
  const dvec3 v(std::sqrt(1 - n_v * n_v), 0, n_v);
  dvec2 sum(0);
  const int rings = 800, turns = 400;
  for (int i = 0; i < rings; ++i) {
    const double n_l = (i + 0.5) / rings;
    for (int j = 0; j < turns; ++j) {
      const double phi = 2 * M_PI * (j + 0.5) / turns, s = std::sqrt(1 - n_l * n_l);
      const dvec3 l(s * std::cos(phi), s * std::sin(phi), n_l), h = normalize(v + l);
      const double d = h.z * h.z * (a2 - 1) + 1, D = a2 / (M_PI * d * d);
      const double V = 0.5 / (n_l * std::sqrt(n_v * n_v * (1 - a2) + a2) + n_v * std::sqrt(n_l * n_l * (1 - a2) + a2));
      const double f = std::pow(1 - dot(v, h), 5.0);
      sum += dvec2(1 - f, f) * (D * V * n_l);
    }
  }
  return sum * (2 * M_PI / (rings * turns));
}

TEST(Coat, ReflectsOfEvenSurroundingsWhatTheIntegralSays) {
  for (const double roughness : {0.4, 0.6, 1.0}) {
    for (const double n_v : {0.2, 0.6, 1.0}) {
      const vec2 got = coat_reflectance(n_v, roughness, 512);
      const dvec2 want = by_quadrature(n_v, roughness);
      EXPECT_NEAR(got.x, want.x, 0.012) << roughness << ' ' << n_v;
      EXPECT_NEAR(got.y, want.y, 0.012) << roughness << ' ' << n_v;
    }
  }
}

TEST(Coat, ASmoothMirrorReflectsEverythingAndARoughOneNeverMore) {
  EXPECT_NEAR(coat_reflectance(1.0, 0.0, 128).x + coat_reflectance(1.0, 0.0, 128).y, 1.0, 1e-3);
  for (const vec2& ab : coat_table(32)) {
    EXPECT_GE(ab.x, 0.0f);
    EXPECT_GE(ab.y, 0.0f);
    EXPECT_LE(ab.x + ab.y, 1.005f);
  }
}

}  // namespace
}  // namespace pliant
