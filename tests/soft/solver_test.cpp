// Every solver behind the seam against a dense factor, on matrices whose answers a test can trust.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

#include "systems/soft/fem/tissue.h"
#include "systems/soft/linear/auto_solver.h"
#include "tests/soft/random_spd.h"

namespace pliant {
namespace {

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
  const Vector x = random_right_side(60, 2);
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
    const Vector b = random_right_side(size, 7), truth = a.dense().llt().solve(b);
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
  const Vector b = random_right_side(83, 4), truth = a.dense().llt().solve(b);
  Vector x = Vector::Zero(249);
  ready(a)->solve(b, x);
  EXPECT_LT(distance(x, truth), 1e-8);
}

TEST_P(EverySolver, FactorisesNewNumbersWithoutANewAnalysis) {
  const Groups groups = brick(3, 4, 5);
  const BlockMatrix before = random_spd(60, groups, 0.1, 1), after = random_spd(60, groups, 0.3, 2);
  const auto solver = ready(before);
  ASSERT_TRUE(solver->factorise(after));
  const Vector b = random_right_side(60, 3);
  Vector x = Vector::Zero(180);
  solver->solve(b, x);
  EXPECT_LT(distance(x, after.dense().llt().solve(b)), 1e-8);
}

TEST_P(EverySolver, SolvesManyColumnsAsItSolvesEach) {
  const BlockMatrix a = random_spd(60, brick(3, 4, 5), 0.1, 5);
  const auto solver = ready(a);
  for (const int count : {0, 1, 3, 8, 21}) {
    Rows columns(180, count);
    for (int c = 0; c < count; ++c) columns.col(c) = random_right_side(60, 10u + static_cast<unsigned>(c));
    const Rows right = columns;
    if (count == 3) {
      Rows larger(200, count);  // a coupled system whose upper rows are these
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

// Threes of few block rows, as contacts push: one row, several, one twice, none, and in two parts that do not hang
// together.
TEST_P(EverySolver, GramMatrixIsThatOfTheDenseInverse) {
  Groups groups;
  for (const auto& tet : brick(3, 4, 5))
    for (std::uint32_t part = 0; part < 2; ++part)
      groups.push_back({2 * tet[0] + part, 2 * tet[1] + part, 2 * tet[2] + part, 2 * tet[3] + part});
  const BlockMatrix a = random_spd(121, groups, 0.1, 5);
  const auto solver = ready(a);
  const double promised = GetParam() == SolverKind::kConjugateGradient ? 1e-6 : 1e-12;
  for (const std::uint32_t count : {0u, 1u, 2u, 3u, 19u}) {
    BlockColumns b;
    b.clear(121);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(363, 3 * count);
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t k = 0; k < i % 4; ++k) {
        const std::uint32_t row = i == 3 ? 120 : (53 * i + 17 * k) % 121;  // the lone last one, thrice
        b.entries.push_back({row, Block(Eigen::Map<const Block>(random_right_side(3, 10 * i + k).data()))});
        dense.block<3, 3>(3 * row, 3 * i) += b.entries.back().value;
      }
      b.close();
    }
    Eigen::MatrixXd gram;
    solver->solve_gram(b, gram);
    ASSERT_EQ(gram.rows(), 3 * count);
    EXPECT_EQ(gram, gram.transpose());
    if (count < 2) {
      EXPECT_TRUE(gram.isZero(0));
      continue;
    }
    const Eigen::MatrixXd truth = dense.transpose() * a.dense().llt().solve(dense);
    EXPECT_LT((gram - truth).norm(), promised * truth.norm()) << count << " threes";
  }
}

TEST_P(EverySolver, GivesTheSameBitsForTheSameNumbers) {
  const BlockMatrix a = random_spd(60, brick(3, 4, 5), 0.1, 5);
  const Vector b = random_right_side(60, 3);
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

// A clamped beam of soft tissue as the soft step has it, nodes near and far: stiffness (T c / h)^2 times inertia.
struct SolverBeam {
  TetMesh mesh;
  std::unique_ptr<Tissue> tissue;

  SolverBeam(std::uint32_t nx, std::uint32_t ny) {
    const double h = 0.1 / (ny - 1);
    mesh.free_count = (nx - 1) * ny * ny;
    // The layer at x = 0 is pinned, and pinned nodes are the last ones.
    const auto shift = [&](std::uint32_t node) { return node < ny * ny ? mesh.free_count + node : node - ny * ny; };
    mesh.nodes.resize(nx * ny * ny);
    for (std::uint32_t node = 0; node < mesh.nodes.size(); ++node)
      mesh.nodes[shift(node)] = h * dvec3(node / (ny * ny), node / ny % ny, node % ny);
    for (Tet tet : brick(nx, ny, ny)) {
      for (std::uint32_t& node : tet) node = shift(node);
      mesh.tets.push_back(tet);
    }
    tissue = std::make_unique<Tissue>(mesh, TissueMaterial{.young = 1e5, .poisson = 0.45}, mesh.free_count);
  }
};

TEST_P(EverySolver, AgreesWithADenseFactorOnABendingBeam) {
  for (const double T : {0.001, 0.01, 0.1, 1e6}) {
    SolverBeam beam(11, 4);
    const auto solver = make_solver(GetParam(), beam.tissue->moving());
    solver->analyse(beam.tissue->inner());
    for (int step = 0; step < 3; ++step) {
      beam.tissue->assemble(T, {0, 0, -9.81});
      solver->place(beam.tissue->position());
      ASSERT_TRUE(solver->factorise(beam.tissue->inner()));
      const Vector b = beam.tissue->right(), truth = beam.tissue->inner().dense().llt().solve(b);
      Vector x = Vector::Zero(b.size());
      solver->solve(b, x);
      EXPECT_LT(distance(x, truth), 2e-8) << "a step of " << T << " s";
      for (std::uint32_t i = 0; i < beam.tissue->moving(); ++i) {
        const dvec3 v(truth[3 * i], truth[3 * i + 1], truth[3 * i + 2]);
        beam.tissue->velocity()[i] = v;
        beam.tissue->position()[i] += std::min(T, 0.05) * v;
      }
    }
  }
}

TEST(ConjugateGradient, NeedsNoMoreIterationsOnTwiceTheNodesWhenItKnowsWhereTheyStand) {
  int iterations[2][2];  // [nodes known][finer]
  for (const bool known : {false, true})
    for (const bool finer : {false, true}) {
      SolverBeam beam(finer ? 23 : 16, finer ? 8 : 6);
      ConjugateGradient solver;
      solver.analyse(beam.tissue->inner());
      beam.tissue->assemble(0.01, {0, 0, -9.81});
      if (known) solver.place(beam.tissue->position());
      ASSERT_TRUE(solver.factorise(beam.tissue->inner()));
      Vector x = Vector::Zero(3 * beam.tissue->moving());
      solver.solve(beam.tissue->right(), x);
      EXPECT_TRUE(solver.converged());
      iterations[known][finer] = solver.iterations();
    }
  for (const bool finer : {false, true}) EXPECT_LT(iterations[true][finer], iterations[false][finer]);
  EXPECT_LE(iterations[true][true], 1.25 * iterations[true][false]);
}

TEST(ConjugateGradient, StartsFromTheGuess) {
  SolverBeam beam(14, 5);
  ConjugateGradient solver;
  solver.analyse(beam.tissue->inner());
  beam.tissue->assemble(0.01, {0, 0, -9.81});
  solver.place(beam.tissue->position());
  ASSERT_TRUE(solver.factorise(beam.tissue->inner()));
  Vector x = Vector::Zero(3 * beam.tissue->moving());
  solver.solve(beam.tissue->right(), x);
  EXPECT_GT(solver.iterations(), 5);
  solver.solve(beam.tissue->right(), x);
  EXPECT_LE(solver.iterations(), 1);
  solver.solve(Vector::Zero(x.size()), x = Vector::Zero(x.size()));
  EXPECT_EQ(solver.iterations(), 0);
  EXPECT_TRUE(x.isZero(0));
}

// One right-hand side by conjugate gradients, many by a factor, and back: always the same answers.
TEST(AutoSolver, ChangesItsMethodAndNotItsAnswers) {
  SolverBeam beam(18, 6);
  AutoSolver solver;
  solver.analyse(beam.tissue->inner());
  for (const int columns : {0, 40, 0, 0, 2, 90, 90}) {
    beam.tissue->assemble(0.01, {0, 0, -9.81});
    solver.place(beam.tissue->position());
    ASSERT_TRUE(solver.factorise(beam.tissue->inner()));
    BlockCholesky direct;
    direct.analyse(beam.tissue->inner());
    ASSERT_TRUE(direct.factorise(beam.tissue->inner()));
    const Vector b = beam.tissue->right();
    Vector x = Vector::Zero(b.size()), truth = x;
    solver.solve(b, x);
    direct.solve(b, truth);
    EXPECT_LT(distance(x, truth), 1e-8);
    if (columns == 0) continue;
    Rows many(b.size(), columns);
    for (int c = 0; c < columns; ++c) many.col(c) = random_right_side(beam.tissue->moving(), static_cast<unsigned>(c));
    Rows right = many;
    solver.solve_many(many);
    direct.solve_many(right);
    EXPECT_LT((many - right).norm(), 1e-8 * right.norm());
    BlockColumns pushes;
    pushes.clear(beam.tissue->moving());
    for (int three = 0; three < columns / 3; ++three) {
      pushes.entries.push_back({static_cast<std::uint32_t>(7 * three) % pushes.size, Block::Identity()});
      pushes.close();
    }
    Eigen::MatrixXd gram, direct_gram;
    solver.solve_gram(pushes, gram);
    direct.solve_gram(pushes, direct_gram);
    EXPECT_LE((gram - direct_gram).norm(), 1e-8 * direct_gram.norm());
  }
}

}  // namespace
}  // namespace pliant
