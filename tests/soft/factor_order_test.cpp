// The sparse factor's order of elimination, and its share among threads.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "runtime/parallel.h"
#include "systems/soft/linear/block_cholesky.h"
#include "systems/soft/linear/nested_dissection.h"
#include "tests/soft/random_spd.h"

namespace pliant {
namespace {

bool is_permutation(std::vector<std::uint32_t> order, std::uint32_t size) {
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> all(size);
  std::iota(all.begin(), all.end(), 0u);
  return order == all;
}

bool all_same_bits(const std::vector<double>& x, const std::vector<double>& y) {
  return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(double)) == 0;
}

void append(std::vector<double>& to, const double* from, Eigen::Index count) {
  to.insert(to.end(), from, from + count);
}

TEST(NestedDissection, OrdersAnyGraph) {
  EXPECT_TRUE(nested_dissection(make_pattern(0, {})).empty());
  for (const std::uint32_t size : {1u, 7u, 8u, 300u})  // without edges
    EXPECT_TRUE(is_permutation(nested_dissection(make_pattern(size, {})), size)) << size;
  const Groups groups = brick(5, 5, 5);
  EXPECT_TRUE(is_permutation(nested_dissection(make_pattern(125, groups)), 125));
  EXPECT_TRUE(is_permutation(nested_dissection(make_pattern(60, groups)), 60));  // cut off, in pieces
  Groups two = groups;                                                           // and nodes that belong to nothing
  for (const auto& g : groups) two.push_back({g[0] + 130, g[1] + 130, g[2] + 130, g[3] + 130});
  EXPECT_TRUE(is_permutation(nested_dissection(make_pattern(260, two)), 260));
  Groups all;  // everything next to everything
  for (std::uint32_t i = 0; i < 40; ++i)
    for (std::uint32_t j = 0; j < i; ++j) all.push_back({i, j, i, j});
  EXPECT_TRUE(is_permutation(nested_dissection(make_pattern(40, all)), 40));
}

TEST(NestedDissection, RepeatsItsOrderWhateverElseDrawsRandomNumbers) {
  const BlockMatrix a = make_pattern(1000, brick(10, 10, 10));
  const std::vector<std::uint32_t> order = nested_dissection(a);
  for (unsigned seed = 1; seed < 4; ++seed) {
    std::srand(seed);
    EXPECT_EQ(nested_dissection(a), order);
  }
}

// A cube of n^3 nodes needs O(n^6) by nested dissection; minimum degree has a larger constant there, a smaller one on
// beams.
TEST(Elimination, TakesTheOrderWithLessWork) {
  for (const auto [x, y, z] : {std::array{12u, 12u, 12u}, std::array{60u, 4u, 4u}, std::array{3u, 3u, 3u}}) {
    const BlockMatrix a = make_pattern(x * y * z, brick(x, y, z));
    const Elimination e = plan_elimination(a);
    EXPECT_TRUE(is_permutation(e.old_of_new, a.size));
    double sum = 0;
    for (const Supernode& s : e.supernodes) sum += flops_of(s);
    EXPECT_EQ(sum, e.flops);
  }
}

// Factor, one and many right-hand sides, and the mutual response of contacts, on bodies whose tree is shared.
TEST(BlockCholesky, GivesTheSameBitsForEveryNumberOfThreads) {
  for (const auto [x, y, z] :
       {std::array{15u, 14u, 14u}, std::array{11u, 11u, 11u}, std::array{40u, 6u, 5u}, std::array{4u, 4u, 4u}}) {
    const std::uint32_t size = x * y * z;
    const BlockMatrix a = random_spd(size, brick(x, y, z), 0.1, 5);
    BlockCholesky solver;
    solver.analyse(a);
    const Vector b = random_right_side(size, 6);
    const Rows right = Rows::NullaryExpr(3 * size, 44, [&](Eigen::Index i, Eigen::Index j) { return b[(i + j) % 97]; });
    BlockColumns pushes;
    pushes.clear(size);
    for (std::uint32_t three = 0; three < 30; ++three) {
      pushes.entries.push_back({31 * three % size, Block::Identity()});
      pushes.entries.push_back({(31 * three + 1) % size, 0.5 * Block::Identity()});
      pushes.close();
    }
    std::vector<double> first;
    for (const unsigned threads : {1u, 2u, 4u, 8u}) {
      set_thread_count(threads);
      ASSERT_TRUE(solver.factorise(a));
      Vector one, product;
      solver.solve(b, one);
      a.multiply(one, product);
      EXPECT_LT((product - b).norm(), 1e-12 * b.norm());
      Rows many = right, seven = right.leftCols(7);
      solver.solve_many(many);
      solver.solve_many(seven);
      EXPECT_LT((many.leftCols(7) - seven).norm(), 1e-12 * seven.norm());
      Eigen::MatrixXd gram;
      solver.solve_gram(pushes, gram);
      ColumnMix mix;
      mix.parts = {{0, 1.0}, {89, -2.0}, {7, 0.5}}, mix.first = {0, 2, 2, 3};
      Rows kept(3 * size, mix.count());
      ASSERT_TRUE(solver.solve_kept(mix, kept));
      std::vector<double> now;
      append(now, kept.data(), kept.size());
      append(now, one.data(), one.size()), append(now, many.data(), many.size());
      append(now, seven.data(), seven.size()), append(now, gram.data(), gram.size());
      if (first.empty()) first = now;
      EXPECT_TRUE(all_same_bits(now, first)) << x << ' ' << y << ' ' << z << ", " << threads << " threads";
    }
    set_thread_count(0);
  }
}

// Combinations of columns by what the mutual response has kept, against solving for them: with entries of the same row,
// empty columns and combinations, other solutions in between.
TEST(BlockCholesky, SolvesForColumnsOfTheLastMutualResponse) {
  for (const auto [x, y, z] : {std::array{15u, 14u, 14u}, std::array{5u, 4u, 4u}}) {
    const std::uint32_t size = x * y * z;
    const BlockMatrix a = random_spd(size, brick(x, y, z), 0.1, 5);
    BlockCholesky solver;
    solver.analyse(a);
    ASSERT_TRUE(solver.factorise(a));
    ColumnMix mix;
    for (Eigen::Index k = 0; k < 11; ++k) {
      mix.parts.push_back({(7 * k) % 36, 1.0 + 0.1 * static_cast<double>(k)});
      if (k % 3 == 0) mix.parts.push_back({(5 * k + 2) % 36, -0.7});
      mix.close();
    }
    mix.close();  // an empty one
    Rows found(3 * size, mix.count());
    EXPECT_FALSE(solver.solve_kept(mix, found));  // before any response
    BlockColumns pushes;
    pushes.clear(size);
    Rows columns = Rows::Zero(3 * size, 36);
    for (std::uint32_t three = 0; three < 12; ++three) {
      for (std::uint32_t k = 0; k < three % 3; ++k) {  // some are empty
        const std::uint32_t row = (17 * three + k / 2) % size;
        const Block value = (1.0 + k) * Block::Identity() + 0.1 * Block::Ones();
        pushes.entries.push_back({row, value});
        columns.block<3, 3>(3 * row, 3 * three) += value;
      }
      pushes.close();
    }
    Eigen::MatrixXd gram;
    solver.solve_gram(pushes, gram);
    Rows expected = Rows::Zero(3 * size, mix.count());
    for (Eigen::Index k = 0; k < mix.count(); ++k)
      for (const ColumnMix::Part& part : mix.of(k)) expected.col(k) += part.factor * columns.col(part.column);
    solver.solve_many(expected);
    ASSERT_TRUE(solver.solve_kept(mix, found));
    EXPECT_LT((found - expected).norm(), 1e-13 * expected.norm());
    EXPECT_TRUE(found.col(mix.count() - 1).isZero(0.0));
    ASSERT_TRUE(solver.factorise(a));
    EXPECT_FALSE(solver.solve_kept(mix, found));  // of another factor
  }
}

// A pivot of any part of the tree that is not positive, on any number of threads.
TEST(BlockCholesky, RefusesAnIndefiniteMatrixOnEveryThread) {
  BlockMatrix a = random_spd(1331, brick(11, 11, 11), 0.1, 5);
  BlockCholesky solver;
  solver.analyse(a);
  for (const unsigned threads : {1u, 2u, 4u}) {
    set_thread_count(threads);
    for (const std::uint32_t row : {0u, 333u, 665u, 1330u}) {
      Block& value = a.value[a.diagonal[row]];
      const Block before = value;
      value(1, 1) = -1.0;
      EXPECT_FALSE(solver.factorise(a)) << row;
      value = before;
    }
    EXPECT_TRUE(solver.factorise(a));
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace pliant
