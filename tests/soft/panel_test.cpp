// The dense kernels of the sparse factor: which version runs, and that versions agree.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "systems/soft/linear/panel_kernels.h"

namespace pliant {
namespace {

struct alignas(64) Strip {
  double lane[kStrip];
};
using Strips = std::vector<Strip>;

bool same_bits(const Strips& x, const Strips& y) {
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(Strip)) == 0;
}

Strips random_strips(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Strips out(count);
  for (Strip& strip : out)
    for (double& number : strip.lane) number = uniform(random);
  return out;
}

TEST(PanelKernels, UseTheWidestRegistersOfTheMachine) {
#if defined(__x86_64__) && !defined(PLIANT_SANITIZED) && !defined(__clang__)
  const bool widest = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq");
  EXPECT_EQ(panel_register_bytes(), widest ? 64 : __builtin_cpu_supports("avx2") ? 32 : 16);
#else
  EXPECT_EQ(panel_register_bytes(), 16);
#endif
  EXPECT_EQ(plain::panel_register_bytes(), 16);
}

TEST(PanelKernels, GiveTheSameBitsWithEveryWidth) {
  for (const int columns : {3, 8, 13, 24})
    for (const int strips : {4, 7}) {
      if (strips * kStrip < columns) continue;  // not a panel: it needs at least as many rows as columns
      const auto size = static_cast<std::size_t>(columns * strips);
      FactorPanel panel{nullptr, columns, strips};
      Strips wide = random_strips(size + 64, 1);  // kernels may read beyond a panel in its array, but not change it
      for (int c = 0; c < columns; ++c)           // a heavy diagonal: positive definite
        wide[static_cast<std::size_t>(c / kStrip * columns + c)].lane[c % kStrip] = 2 * columns;
      Strips plain = wide, reciprocal = random_strips(size, 2), plain_reciprocal = reciprocal;
      const PanelPart all{0, columns, 0, strips};
      ASSERT_TRUE(factorise_part(wide.front().lane, panel, reciprocal.front().lane, all));
      ASSERT_TRUE(plain::factorise_part(plain.front().lane, panel, plain_reciprocal.front().lane, all));
      EXPECT_TRUE(same_bits(wide, plain)) << columns << ' ' << strips;
      EXPECT_TRUE(same_bits(reciprocal, plain_reciprocal)) << columns << ' ' << strips;

      panel.data = wide.front().lane;
      const double* const inverse = reciprocal.front().lane;
      const auto triangle = static_cast<std::size_t>(triangle_size(strips - columns / kStrip)) / kStrip;
      const auto agree = [&](const char* what, std::size_t count, auto run, auto run_plain) {
        Strips x = random_strips(count, 3), y = x;
        run(x.front().lane), run_plain(y.front().lane);
        EXPECT_TRUE(same_bits(x, y)) << what << ' ' << columns << ' ' << strips;
        EXPECT_FALSE(same_bits(x, random_strips(count, 3))) << what << " did nothing";
      };
      Strips sums(size);
      const auto rows = static_cast<std::size_t>(strips);
      agree(
          "update_triangle", triangle, [&](double* x) { update_triangle(panel, x, columns / kStrip, strips); },
          [&](double* x) { plain::update_triangle(panel, x, columns / kStrip, strips); });
      agree(
          "forward", rows, [&](double* x) { forward(panel, inverse, x); },
          [&](double* x) { plain::forward(panel, inverse, x); });
      agree(
          "backward", rows, [&](double* x) { backward(panel, inverse, x, sums.front().lane); },
          [&](double* x) { plain::backward(panel, inverse, x, sums.front().lane); });
      agree(
          "forward_many", rows * kStrip, [&](double* x) { forward_many(panel, inverse, x); },
          [&](double* x) { plain::forward_many(panel, inverse, x); });
      agree(
          "backward_many", rows * kStrip, [&](double* x) { backward_many(panel, inverse, x); },
          [&](double* x) { plain::backward_many(panel, inverse, x); });
      const Strips left = random_strips(rows * kStrip, 4), right = random_strips(rows * kStrip, 5);
      const int step = 2 * kStrip + 1, length = strips * kStrip / 3;  // rows of eight among other columns
      agree(
          "add_gram", kStrip,
          [&](double* x) { add_gram(left.front().lane, step, right.front().lane, kStrip, length, x); },
          [&](double* x) { plain::add_gram(left.front().lane, step, right.front().lane, kStrip, length, x); });
    }
}

}  // namespace
}  // namespace pliant
