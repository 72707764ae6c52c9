// Fibres: the moduli along and across them, their contraction, and their energy.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/tet_shapes.h"
#include "systems/soft/fem/tissue_step.h"

namespace pliant {
namespace {

constexpr double kBlock = 0.1, kMatrix = 1e4, kFibre = 3e4, kNu = 0.3;  // [m], [Pa]

TissueMaterial fibrous(const Fibres& fibres, TissueLaw law = TissueLaw::kCorotational) {
  return {.young = kMatrix, .poisson = kNu, .density = 1e-6, .law = law, .fibres = fibres};
}

// A cube with a uniform strain; that across is found from its stress there.
struct Strained {
  TetMesh mesh = tets::box(2, 2, 2, dvec3(0), dvec3(kBlock));
  Tissue tissue;
  explicit Strained(const TissueMaterial& material) : tissue(mesh, material, mesh.node_count()) {}
  // [Pa] mean stress along an axis when the cube is stretched so.
  double stress(dvec3 stretch, int axis) {
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) tissue.position()[i] = stretch * mesh.nodes[i];
    tissue.find_forces();
    double sum = 0.0;
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i)
      if (mesh.nodes[i][axis] > kBlock - 1e-9) sum -= tissue.elastic_force()[3 * i + axis];
    return sum / (kBlock * kBlock);
  }
  // [Pa] along `axis`, the others being free.
  double uniaxial(double stretch, int axis) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    dvec3 s(1.0);
    s[axis] = stretch;
    for (int i = 0; i < 300; ++i)
      for (const int side : {b, c}) s[side] -= stress(s, side) / (4.0 * (kMatrix + kFibre));
    return stress(s, axis);
  }
};

TEST(Fibres, StiffenABlockAlongThemAndHardlyAcross) {
  const double strain = 1e-5;
  Strained block(fibrous({.young = kFibre, .direction = dvec3(0, 2, 0)}));
  EXPECT_NEAR(block.uniaxial(1 + strain, 1) / strain, kMatrix + kFibre, 1e-3 * kFibre);
  const double across = kMatrix / (1 - kNu * kNu * kFibre / (kMatrix + kFibre));
  for (const int axis : {0, 2}) EXPECT_NEAR(block.uniaxial(1 + strain, axis) / strain, across, 1e-3 * across);
}

TEST(Fibres, OfTensionAloneDoNotResistShortening) {
  Strained block(fibrous({.young = kFibre, .only_tension = true}));
  EXPECT_NEAR(block.uniaxial(1 + 1e-5, 0) / 1e-5, kMatrix + kFibre, 1e-3 * kFibre);
  EXPECT_NEAR(block.uniaxial(1 - 1e-5, 0) / -1e-5, kMatrix, 1e-3 * kMatrix);
}

// Strain e of the whole block: E e + E_f (e + contraction) = 0.
TEST(Fibres, AFreeBlockContractsWithThem) {
  const double contraction = 0.05, period = 0.8;
  TetMesh mesh = tets::box(2, 2, 2, dvec3(-0.5 * kBlock), dvec3(0.5 * kBlock));
  Fibres fibres{.young = kFibre, .direction = dvec3(0, 0, 1), .contraction = contraction, .period = period};
  TissueMaterial material = fibrous(fibres);
  material.density = 1.0;
  Tissue tissue(mesh, material, mesh.node_count());
  auto solver = make_solver(SolverKind::kBlockCholesky, tissue.moving());
  solver->analyse(tissue.inner());
  for (int i = 1; i <= 96; ++i) {
    ASSERT_TRUE(step_tissue(tissue, *solver, 1.0 / 120, dvec3(0)).solved);
    double low = 0.0, high = 0.0;
    for (const dvec3 x : tissue.position()) low = std::min(low, x.z), high = std::max(high, x.z);
    const double now = 0.5 * contraction * (1 - std::cos(2 * std::numbers::pi * i / 120 / period));
    EXPECT_NEAR((high - low) / kBlock, 1 - now * kFibre / (kMatrix + kFibre), 0.01 * contraction) << i;
  }
}

TEST(Fibres, ForcesAreTheGradientOfTheEnergyForEveryLaw) {
  const TetMesh mesh = tets::box(1, 1, 2, dvec3(0), dvec3(0.1, 0.1, 0.2));
  for (const TissueLaw law : {TissueLaw::kCorotational, TissueLaw::kNeoHookean}) {
    Tissue tissue(mesh, fibrous({.young = kFibre, .direction = dvec3(1, 2, 0.5), .contraction = 0.1}, law),
                  mesh.node_count());
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) tissue.position()[i] += 0.02 * tets::scatter(i);
    tissue.find_forces();
    const Vector f = tissue.elastic_force();
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i)
      for (int k = 0; k < 3; ++k) {
        const double h = 1e-6;
        tissue.position()[i][k] += h;
        const double up = tissue.elastic_energy();
        tissue.position()[i][k] -= 2 * h;
        const double down = tissue.elastic_energy();
        tissue.position()[i][k] += h;
        EXPECT_NEAR((down - up) / (2 * h), f[3 * i + k], 1e-5 * f.lpNorm<Eigen::Infinity>());
      }
  }
}

// Stretched well beyond their rest length, fibres have a stiffness across themselves, too: the step's matrix is exact.
TEST(Fibres, TheStepsMatrixIsTheDerivativeOfTheirForces) {
  TetMesh mesh;
  mesh.nodes = {dvec3(0), dvec3(0.1, 0, 0), dvec3(0, 0.1, 0), dvec3(0, 0, 0.1)};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.free_count = 4;
  TissueMaterial material = fibrous({.young = kFibre, .direction = dvec3(1, 1, 0)});
  const auto matrix = [](Tissue& tissue) {
    tissue.assemble(1.0, dvec3(0));
    return tissue.inner().dense();
  };
  const auto stretch = [](Tissue& tissue) {
    for (std::size_t i = 0; i < 4; ++i) tissue.position()[i] *= 1.2;
  };
  Tissue with(mesh, material, 4);
  material.fibres = {};
  Tissue without(mesh, material, 4);
  stretch(with), stretch(without);
  const Eigen::MatrixXd K = matrix(with) - matrix(without);
  for (std::uint32_t i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k) {
      const auto forces = [&](double h) {
        with.position()[i][k] += h, without.position()[i][k] += h;
        with.find_forces(), without.find_forces();
        with.position()[i][k] -= h, without.position()[i][k] -= h;
        return Vector(with.elastic_force() - without.elastic_force());
      };
      const Vector slope = -(forces(1e-7) - forces(-1e-7)) / 2e-7;
      EXPECT_LT((slope - K.col(3 * i + k)).norm(), 1e-5 * K.norm());
    }
}

}  // namespace
}  // namespace pliant
