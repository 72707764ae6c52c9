// Percentiles against sorted samples.
#include "runtime/histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace pliant {
namespace {

TEST(Histogram, PercentilesAgreeWithSortedSamplesWithinABucket) {
  std::mt19937_64 random(11);
  std::lognormal_distribution<double> duration(9.0, 2.0);  // [ns] around 8 us, over five decades
  Histogram histogram;
  std::vector<std::uint64_t> samples;
  for (int i = 0; i < 50000; ++i) {
    samples.push_back(static_cast<std::uint64_t>(duration(random)));
    histogram.add(samples.back());
  }
  std::sort(samples.begin(), samples.end());
  for (double q : {0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(samples.size()))) - 1;
    const double exact = static_cast<double>(samples[rank]) * 1e-3;
    EXPECT_GE(histogram.percentile_us(q), exact) << "a share q does not exceed it, q = " << q;
    EXPECT_LE(histogram.percentile_us(q), exact * (1.0 + 1.0 / 64.0) + 1e-3) << q;  // 64 buckets an octave
  }
  EXPECT_EQ(histogram.max_us(), static_cast<double>(samples.back()) * 1e-3);
  EXPECT_EQ(histogram.count(), samples.size());
}

TEST(Histogram, SaysZeroWhenItHoldsNothing) {
  const Histogram histogram;
  EXPECT_EQ(histogram.percentile_us(0.5), 0.0);
  EXPECT_EQ(histogram.max_us(), 0.0);
}

TEST(Histogram, KeepsTheLongestDurationThatFits) {
  Histogram histogram;
  histogram.add(~std::uint64_t{0});
  histogram.add(0);
  EXPECT_EQ(histogram.percentile_us(0.25), 0.0);
  EXPECT_EQ(histogram.max_us(), static_cast<double>(~std::uint64_t{0}) * 1e-3);
  EXPECT_GT(histogram.percentile_us(1.0), 0.0);
}

}  // namespace
}  // namespace pliant
