// Co-rotational tetrahedra by themselves: what every elastic solid must obey, and what broken elements must survive.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "systems/tool/flesh_step.h"
#include "systems/tool/rotation_vector.h"
#include "tests/scenes/tet_shapes.h"

namespace pliant {
namespace {

const FleshMaterial kTissue{.young = 1e4, .poisson = 0.3, .density = 1000};
constexpr dvec3 kNoGravity{0};

std::unique_ptr<LinearSolver> solver_for(const Flesh& flesh) {
  auto solver = make_solver(SolverKind::kEigenCholesky, flesh.moving());
  solver->analyse(flesh.inner());
  return solver;
}

dvec3 force_on(const Flesh& flesh, std::size_t node) {
  const auto f = flesh.elastic_force().segment<3>(3 * static_cast<Eigen::Index>(node));
  return {f[0], f[1], f[2]};
}

// A little block of [m] 0.1 whose inner nodes are nowhere special.
TetMesh shaken_block(int n) {
  TetMesh mesh = tets::box(n, n, n, dvec3(0), dvec3(0.1));
  for (std::uint32_t i = 0; i < mesh.node_count(); ++i) mesh.nodes[i] += 0.15 * 0.1 / n * tets::scatter(i);
  return mesh;
}

void deform(Flesh& flesh, double part) {
  for (std::uint32_t i = 0; i < flesh.position().size(); ++i) flesh.position()[i] += part * tets::scatter(1000 + i);
}

TEST(Flesh, PatchUnderUniformStrainIsSolvedExactly) {
  TetMesh mesh = shaken_block(4);
  const auto surface = [](dvec3 p) {
    const dvec3 d = glm::abs(p - dvec3(0.05));
    return std::max({d.x, d.y, d.z}) > 0.045;
  };
  tets::hold(mesh, surface);
  ASSERT_GT(mesh.free_count, 20u);
  const dmat3 A = dmat3(1) + 1e-3 * dmat3(3, 1, -2, 0.5, -1, 2, 1, 4, 2);
  Flesh flesh(mesh, kTissue, mesh.free_count);
  auto solver = solver_for(flesh);
  for (std::uint32_t i = mesh.free_count; i < mesh.node_count(); ++i) flesh.position()[i] = A * mesh.nodes[i];
  settle_flesh(flesh, *solver, kNoGravity, {.iterations = 20, .tolerance = 1e-14});
  for (std::uint32_t i = 0; i < mesh.free_count; ++i)
    EXPECT_LT(length(flesh.position()[i] - A * mesh.nodes[i]), 1e-10 * 0.1) << i;
}

TEST(Flesh, RigidMotionsGiveNoForceAndNoEnergy) {
  const TetMesh mesh = shaken_block(3);
  Flesh flesh(mesh, kTissue, mesh.node_count());
  const double scale = kTissue.young * 0.1 * 0.1;  // [N] of strains of order one
  for (std::uint32_t k = 0; k < 20; ++k) {
    const dmat3 R = mat3_cast(rotation_of(3.1 * tets::scatter(k)));
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i)
      flesh.position()[i] = R * mesh.nodes[i] + tets::scatter(50 + k);
    flesh.assemble(1e-2, kNoGravity);
    EXPECT_LT(flesh.elastic_force().lpNorm<Eigen::Infinity>(), 1e-12 * scale) << k;
    EXPECT_LT(flesh.elastic_energy(), 1e-20 * scale) << k;
  }
}

TEST(Flesh, ForceIsMinusTheGradientOfTheEnergyHoweverItIsBent) {
  const TetMesh mesh = shaken_block(2);
  Flesh flesh(mesh, kTissue, mesh.node_count());
  for (const double part : {0.001, 0.01, 0.05}) {  // the last inverts elements
    flesh.position() = mesh.nodes;
    deform(flesh, part);
    const dmat3 R = mat3_cast(rotation_of({0.4, 1.9, -0.8}));
    for (dvec3& x : flesh.position()) x = R * x;
    flesh.assemble(1e-2, kNoGravity);
    const double step = 1e-7, size = flesh.elastic_force().lpNorm<Eigen::Infinity>();
    for (std::uint32_t i = 0; i < mesh.node_count(); i += 2)
      for (int d = 0; d < 3; ++d) {
        const double at = flesh.position()[i][d];
        flesh.position()[i][d] = at + step;
        const double above = flesh.elastic_energy();
        flesh.position()[i][d] = at - step;
        const double below = flesh.elastic_energy();
        flesh.position()[i][d] = at;
        EXPECT_NEAR(force_on(flesh, i)[d], -(above - below) / (2 * step), 1e-5 * size) << part << ' ' << i;
      }
  }
}

TEST(Flesh, MatrixIsTheGradientOfTheForceAtRestAndSymmetricEverywhere) {
  const TetMesh mesh = shaken_block(2);
  Flesh flesh(mesh, kTissue, mesh.node_count());
  const double T = 1.0, step = 1e-8;
  flesh.assemble(T, kNoGravity);
  const Eigen::MatrixXd K = flesh.inner().dense();
  for (std::uint32_t i = 0; i < mesh.node_count(); i += 3) {
    for (int d = 0; d < 3; ++d) {
      flesh.position()[i][d] += step;
      flesh.assemble(T, kNoGravity);
      Vector column = -flesh.elastic_force() / step;
      flesh.position()[i][d] -= step;
      column[3 * i + d] += flesh.mass()[i];
      EXPECT_LT((K.col(3 * i + d) - column).norm(), 1e-5 * column.norm()) << i;
    }
  }
  deform(flesh, 0.03);
  flesh.assemble(T, kNoGravity);
  const Eigen::MatrixXd bent = flesh.inner().dense();
  EXPECT_EQ((bent - bent.transpose()).norm(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(bent);
  EXPECT_GT(spectrum.eigenvalues().minCoeff(), 0.0);
}

// The whole of A with every node moving, against what a flesh hands out that has handle nodes and pinned ones.
TEST(Flesh, InnerOuterAndCornerAreTheWholeMatrixCutInPieces) {
  TetMesh mesh = shaken_block(3);
  tets::hold(
      mesh, [](dvec3 p) { return p.x < 0.03; }, [](dvec3 p) { return p.x > 0.06; });
  FleshMaterial damped = kTissue;
  damped.alpha = 3, damped.beta = 0.02;
  ASSERT_GT(mesh.free_count, 0u);
  ASSERT_GT(mesh.handle_count, 0u);
  TetMesh loose = mesh;
  loose.free_count = mesh.node_count(), loose.handle_count = 0;
  Flesh part(mesh, damped, mesh.free_count), whole(loose, damped, mesh.node_count());
  for (Flesh* flesh : {&part, &whole}) {
    deform(*flesh, 0.004);
    for (std::uint32_t i = 0; i < mesh.node_count(); ++i) flesh->velocity()[i] = tets::scatter(77 + i);
    flesh->assemble(0.02, {0, -9.81, 0});
  }
  const Eigen::MatrixXd A = whole.inner().dense();
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(A.rows(), A.cols());
  const Eigen::Index free = 3 * mesh.free_count, end = 3 * mesh.pinned_begin(), pinned = A.rows() - end;
  B.topLeftCorner(free, free) = part.inner().dense();
  for (const Flesh::Entry& entry : part.outer()) {
    ASSERT_TRUE(entry.row < part.moving() && entry.column >= part.moving() && entry.column < mesh.pinned_begin());
    B.block<3, 3>(3 * entry.row, 3 * entry.column) += entry.value;
    B.block<3, 3>(3 * entry.column, 3 * entry.row) += entry.value.transpose();
  }
  for (const Flesh::Entry& entry : part.corner()) B.block<3, 3>(3 * entry.row, 3 * entry.column) += entry.value;
  const Eigen::MatrixXd kept = A.topLeftCorner(end, end);
  EXPECT_LT((B.topLeftCorner(end, end) - kept).norm(), 1e-14 * kept.norm());
  Vector told(pinned);
  for (std::uint32_t i = mesh.pinned_begin(), k = 0; i < mesh.node_count(); ++i)
    for (int d = 0; d < 3; ++d) told[k++] = part.velocity()[i][d];
  const Vector right = whole.right().head(end) - A.block(0, end, end, pinned) * told;
  EXPECT_LT((part.right() - right).norm(), 1e-13 * right.norm());
}

struct Momentum {
  dvec3 linear{0}, angular{0};
  double size = 0.0, arm_size = 0.0;  // sums of magnitudes, what rounding is measured by
};
Momentum momentum(const Flesh& flesh) {
  Momentum out;
  for (std::size_t i = 0; i < flesh.mass().size(); ++i) {
    const dvec3 p = flesh.mass()[i] * flesh.velocity()[i];
    out.linear += p;
    out.angular += cross(flesh.position()[i], p);
    out.size += length(p);
    out.arm_size += length(flesh.position()[i]) * length(p);
  }
  return out;
}

void throw_spinning(Flesh& flesh, double wobble) {
  for (std::uint32_t i = 0; i < flesh.position().size(); ++i)
    flesh.velocity()[i] =
        dvec3(0.3, 0.1, -0.2) + cross(dvec3(4, -6, 5), flesh.position()[i] - dvec3(0.05)) + wobble * tets::scatter(i);
}

TEST(Flesh, InternalForcesHaveNeitherSumNorMoment) {
  const TetMesh mesh = shaken_block(3);
  Flesh flesh(mesh, kTissue, mesh.node_count());
  deform(flesh, 0.03);
  flesh.assemble(1e-2, kNoGravity);
  dvec3 sum(0), moment(0);
  double size = 0, arm_size = 0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const dvec3 f = force_on(flesh, i);
    sum += f, moment += cross(flesh.position()[i], f);
    size += length(f), arm_size += length(f) * length(flesh.position()[i]);
  }
  EXPECT_LT(length(sum), 1e-12 * size);
  EXPECT_LT(length(moment), 1e-12 * arm_size);
}

TEST(Flesh, LinearMomentumOfAFreeBodyIsKeptByEveryScheme) {
  const TetMesh mesh = shaken_block(2);
  FleshMaterial damped = kTissue;
  damped.beta = 0.01;
  for (const Scheme scheme : {Scheme::kEuler, Scheme::kMidpoint}) {
    Flesh flesh(mesh, damped, mesh.node_count());
    auto solver = solver_for(flesh);
    throw_spinning(flesh, 0.2);
    const Momentum before = momentum(flesh);
    for (int i = 0; i < 200; ++i) step_flesh(flesh, *solver, 0.01, kNoGravity, {.scheme = scheme});
    EXPECT_LT(length(momentum(flesh).linear - before.linear), 1e-12 * before.size);
  }
}

TEST(Flesh, AngularMomentumOfAFreeBodyIsKeptByTheIteratedMidpoint) {
  const TetMesh mesh = shaken_block(2);
  Flesh flesh(mesh, kTissue, mesh.node_count());
  auto solver = solver_for(flesh);
  throw_spinning(flesh, 0.2);
  const Momentum before = momentum(flesh);
  for (int i = 0; i < 100; ++i)
    step_flesh(flesh, *solver, 2e-3, kNoGravity, {.scheme = Scheme::kMidpoint, .iterations = 50, .tolerance = 1e-14});
  EXPECT_LT(length(momentum(flesh).linear - before.linear), 1e-12 * before.size);
  EXPECT_LT(length(momentum(flesh).angular - before.angular), 1e-12 * before.arm_size);
}

}  // namespace
}  // namespace pliant
