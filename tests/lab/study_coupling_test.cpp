// The study `coupling` against known results: springs tend to slaved nodes, and a staggered handle must be heavy.
#include "lab/study/coupling/study_coupling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pliant {
namespace {

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    most = std::max(most, std::abs(a[i] - b[i])), size = std::max(size, std::abs(a[i]));
  return most / size;
}

TEST(StudyCoupling, SpringsTendToSlavedNodesAsTheyStiffen) {
  const CoupledBar bar(3);
  const auto at = [&](double tie) {
    const CouplingCase c{1e-3, tie, 10.0};
    return apart(bar.swing(Coupled::kSlaved, c, 100), bar.swing(Coupled::kSprings, c, 100));
  };
  EXPECT_LT(at(1e4), 1e-2);
  EXPECT_NEAR(at(1e3) / at(1e4), 10.0, 3.0) << "of first order in their compliance";
}

TEST(StudyCoupling, OneSystemIsStableAndTakingTurnsIsNotWithALightHandle) {
  const CoupledBar bar(3);
  for (const double heaviness : {0.01, 1.0, 100.0})
    for (const bool springs : {false, true}) {
      const CouplingCase c{4e-3, 1e3, heaviness};
      EXPECT_FALSE(bar.swing(springs ? Coupled::kSprings : Coupled::kSlaved, c, 200).empty()) << heaviness;
      EXPECT_EQ(bar.swing(springs ? Coupled::kStaggeredSprings : Coupled::kStaggeredSlaved, c, 200).empty(),
                heaviness < 0.1)
          << heaviness;
    }
}

}  // namespace
}  // namespace pliant
