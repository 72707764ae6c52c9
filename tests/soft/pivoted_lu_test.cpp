// The factorisation with row exchanges, against Eigen's.
#include "systems/soft/linear/pivoted_lu.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace pliant {
namespace {

TEST(PivotedLu, SolvesWhatEigenSolves) {
  for (int n = 1; n < 40; ++n) {
    std::srand(static_cast<unsigned>(n));
    const Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n);
    const Eigen::VectorXd b = Eigen::VectorXd::Random(n);
    Eigen::MatrixXd lu = Eigen::MatrixXd::Constant(n + 3, n, 7.0);  // columns farther apart than they are long
    lu.topRows(n) = a;
    std::vector<int> pivots(static_cast<std::size_t>(n));
    ASSERT_TRUE(factorise_lu(lu.data(), n, n + 3, pivots.data()));
    Eigen::VectorXd x = b;
    solve_lu(lu.data(), n, n + 3, pivots.data(), x.data());
    const Eigen::VectorXd expected = a.fullPivLu().solve(b);
    EXPECT_LT((x - expected).norm(), 1e-9 * (1.0 + expected.norm())) << n;
    EXPECT_EQ(lu.bottomRows(3).minCoeff(), 7.0) << "nothing is written beside the matrix";
  }
}

TEST(PivotedLu, RefusesWhatHasNoInverse) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Random(6, 6);
  a.col(4).setZero();
  std::vector<int> pivots(6);
  EXPECT_FALSE(factorise_lu(a.data(), 6, 6, pivots.data()));
  a.setConstant(std::nan(""));
  EXPECT_FALSE(factorise_lu(a.data(), 6, 6, pivots.data()));
}

}  // namespace
}  // namespace pliant
