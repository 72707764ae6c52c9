// Eight elements at a time against each by itself, in plain words.
#include "systems/soft/fem/element.h"

#include <gtest/gtest.h>

#include <random>

#include "scenes/tet_shapes.h"
#include "systems/soft/fem/polar.h"

namespace pliant {
namespace {

TEST(Element, EightLanesAgreeWithEachElementByItselfBentInvertedOrCollapsed) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const double lambda = 3e3, mu = 2e3;
  int inverted = 0;
  for (int round = 0; round < 2000; ++round) {
    std::vector<dvec3> rest, now;
    ElementPack pack;
    pack.count = 1 + static_cast<std::size_t>(round) % kElementLanes;
    for (std::size_t lane = 0; lane < pack.count; ++lane) {
      const auto n = static_cast<std::uint32_t>(rest.size());
      pack.node[lane] = {n, n + 1, n + 2, n + 3};
      const double stir = lane % 3 == 0 ? 1.0 : 0.2;  // every third: anything
      for (int k = 0; k < 4; ++k) {
        rest.emplace_back(normal(random), normal(random), normal(random));
        now.push_back(rest.back() + stir * dvec3(normal(random), normal(random), normal(random)));
      }
      if (round % 50 == 0 && lane == 1) now[n + 3] = now[n];
      std::array<dvec3, 3> b;
      pack.volume[lane] = rest_shape(rest, pack.node[lane], b);
      for (int k = 0; k < 3; ++k)
        for (int d = 0; d < 3; ++d) pack.gradient[k][d][lane] = b[k][d];
      pack.q[0][lane] = 1;
    }
    ElementVisit visit;
    take_edges(pack, now, visit);
    take_rotations(pack, visit);
    turn_gradients(pack, visit);
    take_forces(pack, lambda, mu, visit);
    for (std::size_t lane = 0; lane < pack.count; ++lane) {
      const std::size_t n = 4 * lane;
      const dmat3 X(rest[n + 1] - rest[n], rest[n + 2] - rest[n], rest[n + 3] - rest[n]);
      const dmat3 x(now[n + 1] - now[n], now[n + 2] - now[n], now[n + 3] - now[n]);
      const double volume = std::abs(determinant(X)) / 6;
      EXPECT_NEAR(pack.volume[lane], volume, 1e-12 * volume);
      const dmat3 F = x * inverse(X);
      inverted += determinant(F) < 0;
      dquat q(1, 0, 0, 0);
      extract_rotation(F, q);
      const dmat3 S = transpose(mat3_cast(q)) * F, e = 0.5 * (S + transpose(S)) - dmat3(1);
      const double trace = e[0][0] + e[1][1] + e[2][2];
      double energy = 0.5 * lambda * trace * trace, size = 0;
      for (int c = 0; c < 3; ++c) energy += mu * dot(e[c], e[c]), size += dot(F[c], F[c]);
      EXPECT_NEAR(visit.energy[lane], volume * energy, 1e-9 * volume * mu * size) << round << ' ' << lane;
      // f_k = -V P b_k, P = R sigma, b_k the rows of X^-1.
      const dmat3 P = mat3_cast(q) * (2 * mu * e + dmat3(lambda * trace)), B = transpose(inverse(X));
      dvec3 sum(0);
      for (int k = 0; k < 4; ++k) {
        const dvec3 f(visit.f[k][0][lane], visit.f[k][1][lane], visit.f[k][2][lane]);
        sum += f;
        if (k == 0) continue;
        const dvec3 expected = -volume * (P * B[k - 1]);
        EXPECT_LT(length(f - expected), 1e-9 * volume * mu * (1 + size) * length(B[k - 1])) << round << ' ' << lane;
      }
      EXPECT_LT(length(sum), 1e-9 * volume * mu * (1 + size) * (length(B[0]) + length(B[1]) + length(B[2])));
    }
  }
  EXPECT_GT(inverted, 500);
}

TEST(Element, FlatRestShapesHaveNoVolume) {
  std::array<dvec3, 3> b;
  const std::vector<dvec3> nodes{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-12}, {0, 0, 1}};
  EXPECT_EQ(rest_shape(nodes, {0, 1, 2, 3}, b), 0.0);
  EXPECT_EQ(rest_shape(nodes, {0, 1, 1, 2}, b), 0.0);
  EXPECT_EQ(rest_shape(nodes, {2, 2, 2, 2}, b), 0.0);
  EXPECT_NEAR(rest_shape(nodes, {0, 1, 2, 4}, b), 1.0 / 6, 1e-16);
  EXPECT_NEAR(rest_shape(nodes, {1, 0, 2, 4}, b), 1.0 / 6, 1e-16);
}

}  // namespace
}  // namespace pliant
