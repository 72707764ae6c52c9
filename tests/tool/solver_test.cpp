// Every solver behind the seam against a dense factor, on matrices whose answers a test can trust.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

#include "systems/tool/linear_solver.h"

namespace pliant {
namespace {

using Groups = std::vector<std::array<std::uint32_t, 4>>;

// A brick of n^3 nodes, a path of tetrahedra through each cell (Kuhn's six).
Groups brick(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz) {
  const auto node = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) { return (i * ny + j) * nz + k; };
  Groups out;
  const std::array<std::array<int, 3>, 6> paths{{{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (std::uint32_t i = 0; i + 1 < nx; ++i)
    for (std::uint32_t j = 0; j + 1 < ny; ++j)
      for (std::uint32_t k = 0; k + 1 < nz; ++k)
        for (const auto& path : paths) {
          std::array<std::uint32_t, 3> at{i, j, k};
          std::array<std::uint32_t, 4> tet{node(i, j, k), 0, 0, 0};
          for (std::size_t s = 0; s < 3; ++s) {
            ++at[static_cast<std::size_t>(path[s])];
            tet[s + 1] = node(at[0], at[1], at[2]);
          }
          out.push_back(tet);
        }
  return out;
}

// Adds G^T G for a random G of each group, like a stiff element, and a mass: symmetric positive definite.
BlockMatrix random_spd(std::uint32_t size, const Groups& groups, double mass, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  BlockMatrix a = make_pattern(size, groups);
  for (const auto& group : groups) {
    const Eigen::Matrix<double, 6, 12> G = Eigen::Matrix<double, 6, 12>::NullaryExpr([&] { return uniform(random); });
    const Eigen::Matrix<double, 12, 12> K = G.transpose() * G;
    for (std::uint32_t i = 0; i < 4; ++i)
      for (std::uint32_t j = 0; j < 4; ++j)
        if (group[i] < size && group[j] < size) a.value[a.find(group[i], group[j])] += K.block<3, 3>(3 * i, 3 * j);
  }
  for (const std::uint32_t k : a.diagonal) a.value[k] += mass * Block::Identity();
  return a;
}

Vector random_vector(std::uint32_t block_rows, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Vector::NullaryExpr(3 * block_rows, [&] { return uniform(random); });
}

double distance(const Vector& x, const Vector& truth) {
  return (x - truth).norm() / truth.norm();
}

TEST(BlockMatrix, PatternHoldsEveryCouplingOnceAscendingAndItsDiagonal) {
  // Two tetrahedra that share a face; node 5 is left out, node 6 belongs to none.
  const Groups groups{{0, 1, 2, 3}, {1, 2, 3, 9}};
  const BlockMatrix a = make_pattern(6, groups);
  ASSERT_EQ(a.size, 6u);
  for (std::uint32_t i = 0; i < 6; ++i) {
    EXPECT_EQ(a.column[a.diagonal[i]], i);
    EXPECT_EQ(a.find(i, i), a.diagonal[i]);
    EXPECT_EQ(a.first[i + 1] - a.first[i], i < 4 ? 4u : 1u);
    EXPECT_TRUE(std::is_sorted(a.column.begin() + a.first[i], a.column.begin() + a.first[i + 1]));
  }
  EXPECT_EQ(a.find(0, 4), 0xffffffffu);
  EXPECT_EQ(a.find(4, 0), 0xffffffffu);
  EXPECT_TRUE(a.dense().isZero(0));
}

TEST(BlockMatrix, ProductIsTheDenseProduct) {
  const BlockMatrix a = random_spd(60, brick(3, 4, 5), 0.1, 1);
  const Vector x = random_vector(60, 2);
  Vector y;
  a.multiply(x, y);
  EXPECT_LT(distance(y, a.dense() * x), 1e-14);
  EXPECT_TRUE(a.dense().isApprox(a.dense().transpose(), 1e-15));
}

class EverySolver : public testing::TestWithParam<SolverKind> {
 protected:
  std::unique_ptr<LinearSolver> ready(const BlockMatrix& a) const {
    auto solver = make_solver(GetParam(), a.size);
    solver->analyse(a);
    EXPECT_TRUE(solver->factorise(a));
    return solver;
  }
};

INSTANTIATE_TEST_SUITE_P(Solvers, EverySolver, testing::ValuesIn(available_solvers()), [](const auto& param) {
  std::string name{make_solver(param.param, 1)->name()};
  std::erase(name, '-');
  return name;
});

TEST_P(EverySolver, AgreesWithADenseFactorOnBricksOfManySizes) {
  for (const auto& [nx, ny, nz] :
       {std::array{0u, 1u, 1u}, {1u, 1u, 1u}, {1u, 1u, 2u}, {2u, 2u, 2u}, {2u, 3u, 7u}, {5u, 5u, 9u}}) {
    const std::uint32_t size = nx * ny * nz;
    const BlockMatrix a = random_spd(size, brick(nx, ny, nz), 0.05, size);
    const auto solver = ready(a);
    const Vector b = random_vector(size, 7), truth = a.dense().llt().solve(b);
    Vector x = Vector::Zero(3 * size);
    solver->solve(b, x);
    EXPECT_LE((x - truth).norm(), 1e-8 * truth.norm()) << size << " block rows";
  }
}

TEST_P(EverySolver, SolvesGraphsThatDoNotHangTogether) {
  // Three bricks and two lone nodes, numbered in turn: neighbours are far apart in memory.
  Groups groups;
  for (const auto& tet : brick(3, 3, 3))
    for (std::uint32_t part = 0; part < 3; ++part)
      groups.push_back({3 * tet[0] + part, 3 * tet[1] + part, 3 * tet[2] + part, 3 * tet[3] + part});
  const BlockMatrix a = random_spd(83, groups, 0.2, 3);
  const Vector b = random_vector(83, 4), truth = a.dense().llt().solve(b);
  Vector x = Vector::Zero(249);
  ready(a)->solve(b, x);
  EXPECT_LT(distance(x, truth), 1e-8);
}

TEST_P(EverySolver, FactorisesNewNumbersWithoutANewAnalysis) {
  const Groups groups = brick(3, 4, 5);
  const BlockMatrix before = random_spd(60, groups, 0.1, 1), after = random_spd(60, groups, 0.3, 2);
  const auto solver = ready(before);
  ASSERT_TRUE(solver->factorise(after));
  const Vector b = random_vector(60, 3);
  Vector x = Vector::Zero(180);
  solver->solve(b, x);
  EXPECT_LT(distance(x, after.dense().llt().solve(b)), 1e-8);
}

TEST_P(EverySolver, SolvesManyColumnsAsItSolvesEach) {
  const BlockMatrix a = random_spd(60, brick(3, 4, 5), 0.1, 5);
  const auto solver = ready(a);
  for (const int count : {1, 3, 8, 21}) {
    Rows columns(180, count);
    for (int c = 0; c < count; ++c) columns.col(c) = random_vector(60, 10u + static_cast<unsigned>(c));
    const Rows right = columns;
    if (count == 3) {
      Rows larger(200, count);  // a coupled system of which these are the upper rows
      larger << columns, Rows::Ones(20, count);
      solver->solve_many(larger.topRows(180));
      EXPECT_TRUE(larger.bottomRows(20).isOnes(0));
      columns = larger.topRows(180);
    } else {
      solver->solve_many(columns);
    }
    for (int c = 0; c < count; ++c) {
      Vector x = Vector::Zero(180);
      solver->solve(right.col(c), x);
      EXPECT_LT(distance(columns.col(c), x), 1e-8) << "column " << c << " of " << count;
    }
  }
}

TEST_P(EverySolver, GivesTheSameBitsForTheSameNumbers) {
  const BlockMatrix a = random_spd(60, brick(3, 4, 5), 0.1, 5);
  const Vector b = random_vector(60, 3);
  Vector x = Vector::Zero(180), again = x;
  ready(a)->solve(b, x);
  ready(a)->solve(b, again);
  EXPECT_EQ(x, again);
}

TEST_P(EverySolver, RefusesWhatIsNotPositiveDefinite) {
  const BlockMatrix good = random_spd(60, brick(3, 4, 5), 0.1, 5);
  const auto solver = ready(good);
  BlockMatrix indefinite = good;
  for (const std::uint32_t k : indefinite.diagonal) indefinite.value[k] -= 20 * Block::Identity();
  EXPECT_FALSE(solver->factorise(indefinite));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    BlockMatrix broken = good;
    broken.value[broken.diagonal[31]](1, 1) = bad;
    EXPECT_FALSE(solver->factorise(broken));
  }
  EXPECT_TRUE(solver->factorise(good)) << "a refused matrix must not spoil the next";
}

}  // namespace
}  // namespace pliant
