// Monotone interpolation: exact at its points, monotone and bounded between them, with continuous slope.
#include "editor/document/monotone.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pliant {
namespace {

Monotone uneven() {
  Monotone it;
  it.time = {0.0, 0.5, 0.7, 2.0, 2.1, 3.0};
  it.value = {0.0, 1.0, 1.0, 4.0, 9.0, 9.5};
  return it;
}

TEST(Monotone, PassesThroughItsPoints) {
  const Monotone it = uneven();
  for (std::size_t i = 0; i + 1 < it.time.size(); ++i) {
    EXPECT_DOUBLE_EQ(it.at(i, it.time[i]), it.value[i]);
    EXPECT_DOUBLE_EQ(it.at(i, it.time[i + 1]), it.value[i + 1]);
  }
}

TEST(Monotone, NeverFallsBetweenRisingValues) {
  const Monotone it = uneven();
  double before = it.value.front();
  for (std::size_t i = 0; i + 1 < it.time.size(); ++i)
    for (int k = 0; k <= 100; ++k) {
      const double now = it.at(i, it.time[i] + (it.time[i + 1] - it.time[i]) * k / 100.0);
      EXPECT_GE(now, before - 1e-12);
      EXPECT_LE(now, it.value[i + 1] + 1e-12);
      before = now;
    }
}

TEST(Monotone, HasTheSameSlopeOnBothSidesOfAPoint) {
  const Monotone it = uneven();
  const double h = 1e-7;
  for (std::size_t i = 1; i + 1 < it.time.size(); ++i) {
    const double before = (it.value[i] - it.at(i - 1, it.time[i] - h)) / h,
                 after = (it.at(i, it.time[i] + h) - it.value[i]) / h;
    EXPECT_NEAR(before, it.slope(i), 1e-3) << i;
    EXPECT_NEAR(after, it.slope(i), 1e-3) << i;
  }
}

TEST(Monotone, IsStraightWhereItIsNotSmooth) {
  Monotone it = uneven();
  it.smooth = false;
  EXPECT_NEAR(it.at(3, 2.05), 6.5, 1e-12);
}

}  // namespace
}  // namespace pliant
