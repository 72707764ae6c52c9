// Hollows with a pressure: against Lame's thick sphere, finite differences, and a volume that stays.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "content/tets/tet_hollows.h"
#include "scenes/tet_shapes.h"
#include "systems/soft/fem/tissue_step.h"
#include "systems/soft/linear/low_rank_solver.h"
#include "tests/soft/random_spd.h"

namespace pliant {
namespace {

constexpr double kInner = 0.02, kOuter = 0.04, kShellYoung = 1e4;  // [m], [Pa]

// A thick sphere: the cells of a cube around the middle half, each shell of cells made round.
TetMesh shell(int cells) {
  const TetMesh cube = tets::box(cells, cells, cells, dvec3(-1), dvec3(1));
  TetMesh mesh;
  std::vector<std::uint32_t> number(cube.node_count(), 0xffffffffu);
  for (const Tet& t : cube.tets) {
    dvec3 middle(0);
    for (const std::uint32_t n : t) middle += 0.25 * cube.nodes[n];
    if (std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)}) < 0.5) continue;
    Tet own{};
    for (std::size_t k = 0; k < 4; ++k) {
      if (number[t[k]] == 0xffffffffu) {
        number[t[k]] = mesh.node_count();
        const dvec3 p = cube.nodes[t[k]];
        const double far = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        mesh.nodes.push_back(kOuter * far * normalize(p));
      }
      own[k] = number[t[k]];
    }
    mesh.tets.push_back(own);
  }
  mesh.free_count = mesh.node_count();
  return mesh;
}

void fill(TetMesh& mesh, double pressure, double bulk) {
  mesh.cavities.clear();
  for (std::vector<uvec3>& wall : hollows_of(mesh)) mesh.cavities.push_back({std::move(wall), pressure, bulk});
}

struct Shell {
  TetMesh mesh;
  Tissue tissue;
  std::unique_ptr<LinearSolver> solver;
  Shell(TetMesh of, const TissueMaterial& material)
      : mesh(std::move(of)),
        tissue(mesh, material, mesh.free_count),
        solver(solver_of(tissue, make_solver(SolverKind::kBlockCholesky, mesh.free_count))) {
    solver->analyse(tissue.inner());
  }
  void step(double T) { EXPECT_TRUE(step_tissue(tissue, *solver, T, dvec3(0)).solved); }
};

// [1] Displacement of the inner wall against Lame's.
double lame_error(int cells, double poisson) {
  TetMesh mesh = shell(cells);
  const double p = 0.005 * kShellYoung;
  fill(mesh, p, 0.0);
  EXPECT_EQ(mesh.cavities.size(), 1u);
  Shell it(std::move(mesh), {.young = kShellYoung, .poisson = poisson, .density = 1.0});
  for (int i = 0; i < 3; ++i) it.step(1.0);
  double sum = 0.0, count = 0.0;
  for (std::uint32_t i = 0; i < it.mesh.node_count(); ++i) {
    const double r = length(it.mesh.nodes[i]);
    if (r > kInner * 1.001) continue;
    sum += dot(it.tissue.position()[i] - it.mesh.nodes[i], it.mesh.nodes[i]) / r, count += 1.0;
  }
  const double a3 = std::pow(kInner, 3), b3 = std::pow(kOuter, 3), r = kInner;
  const double want = p * a3 / (kShellYoung * (b3 - a3)) * ((1 - 2 * poisson) * r + (1 + poisson) * b3 / (2 * r * r));
  return sum / count / want - 1;
}

TEST(Cavity, AThickSphereGivesWayAsLameSays) {
  const double coarse = lame_error(8, 0.3), fine = lame_error(16, 0.3);  // -18 and -5 %: facets, of second order
  EXPECT_LT(std::abs(fine), 0.35 * std::abs(coarse));
  EXPECT_LT(std::abs(fine + (fine - coarse) / 3), 0.01) << fine << ' ' << coarse;
}

// Two caps are pressed together by a third of the diameter, at the step of a level.
double squeezed_volume(double bulk, double& pressure) {
  TetMesh mesh = shell(8);
  tets::hold(mesh, [](dvec3 p) { return std::abs(p.z) > 0.85 * kOuter; });
  fill(mesh, 0.0, bulk);
  Shell it(std::move(mesh), {.young = kShellYoung, .poisson = 0.3, .density = 1000, .beta = 0.02});
  for (int i = 0; i < 120; ++i) {
    for (std::uint32_t n = it.mesh.free_count; n < it.mesh.node_count(); ++n)
      it.tissue.velocity()[n].z = i < 60 ? -0.3 * kOuter * (it.mesh.nodes[n].z > 0 ? 1.0 : -1.0) : 0.0;
    it.step(1.0 / 60);
  }
  pressure = it.tissue.cavities().pressure(0, it.tissue.position());
  return it.tissue.cavities().volume(0, it.tissue.position()) / it.tissue.cavities().rest_volume(0);
}

TEST(Cavity, LiquidKeepsItsVolumeWhenItIsPressed) {
  double empty_pressure = 0.0, low = 0.0, high = 0.0;
  EXPECT_LT(squeezed_volume(0.0, empty_pressure), 0.9);
  EXPECT_EQ(empty_pressure, 0.0);
  for (const double bulk : {1e6, 2.2e9}) {
    double pressure = 0.0;
    EXPECT_NEAR(squeezed_volume(bulk, pressure), 1.0, 0.01) << bulk;
    EXPECT_GT(pressure, 0.02 * kShellYoung);
    (low == 0.0 ? low : high) = pressure;
  }
  EXPECT_NEAR(high, low, 0.01 * low);  // that which it takes, however stiff the liquid
}

TEST(Cavity, ForcesAreTheGradientOfTheEnergyAndNeitherPushNorTurnTheBody) {
  TetMesh mesh = shell(4);
  fill(mesh, 300.0, 5e3);
  const Cavities cavities(mesh);
  std::vector<dvec3> x = mesh.nodes;
  for (std::uint32_t i = 0; i < x.size(); ++i) x[i] += dvec3(0.3, 0, 0) + 0.005 * tets::scatter(i);
  Vector f = Vector::Zero(3 * static_cast<Eigen::Index>(x.size()));
  cavities.add_forces(x, f);
  dvec3 sum(0), moment(0);
  const double size = f.lpNorm<Eigen::Infinity>();
  for (std::uint32_t i = 0; i < x.size(); ++i) {
    const dvec3 each(f[3 * i], f[3 * i + 1], f[3 * i + 2]);
    sum += each, moment += cross(x[i], each);
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-6;
      x[i][k] += h;
      const double up = cavities.energy(x);
      x[i][k] -= 2 * h;
      const double down = cavities.energy(x);
      x[i][k] += h;
      EXPECT_NEAR((down - up) / (2 * h), f[3 * i + k], 1e-5 * size);
    }
  }
  EXPECT_LT(length(sum), 1e-12 * size * static_cast<double>(x.size()));
  EXPECT_LT(length(moment), 1e-12 * size * static_cast<double>(x.size()));
}

TEST(Cavity, AFewColumnsAreAddedToAnySolver) {
  const BlockMatrix a = random_spd(27, brick(3, 3, 3), 0.5, 1);
  Rows U(81, 2);
  for (int c = 0; c < 2; ++c) U.col(c) = 1e3 * random_right_side(27, 10 + static_cast<unsigned>(c));
  const Eigen::MatrixXd whole = a.dense() + U * U.transpose();
  const Eigen::LDLT<Eigen::MatrixXd> truth(whole);
  for (const SolverKind kind : {SolverKind::kBlockCholesky, SolverKind::kDense}) {
    LowRankSolver solver(make_solver(kind, 27), U);
    solver.analyse(a);
    ASSERT_TRUE(solver.factorise(a));
    const Vector b = random_right_side(27, 5), want = truth.solve(b);
    Vector x = Vector::Zero(81);
    solver.solve(b, x);
    EXPECT_LT((x - want).norm(), 1e-8 * want.norm());
    BlockColumns columns;
    columns.clear(27);
    for (const std::uint32_t node : {3u, 17u}) {
      columns.entries.push_back({node, Block::Identity()}), columns.entries.push_back({node + 1, 0.5 * Block::Ones()});
      columns.close();
    }
    Rows many = Rows::Zero(81, 6);
    for (Eigen::Index i = 0; i < 2; ++i)
      for (const BlockColumns::Entry& e : columns.of(i)) many.block<3, 3>(3 * e.row, 3 * i) += e.value;
    const Eigen::MatrixXd dense = many, of_truth = truth.solve(dense);
    Eigen::MatrixXd gram;
    solver.solve_gram(columns, gram);
    EXPECT_LT((gram - dense.transpose() * of_truth).norm(), 1e-8 * of_truth.norm());
    solver.solve_many(many);
    EXPECT_LT((Eigen::MatrixXd(many) - of_truth).norm(), 1e-8 * of_truth.norm());
  }
}

}  // namespace
}  // namespace pliant
