// The coupled solve against the whole matrix, dense: for random blocks, and for tools of both attachments.
#include "systems/soft/body/schur.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "systems/soft/body/rotation_vector.h"
#include "systems/soft/body/soft_body_state.h"
#include "tests/soft/bar.h"

namespace pliant {
namespace {

constexpr double kSchurStep = 1.0 / 60;  // [s]
constexpr dvec3 kSchurGravity{0, -9.81, 0};

// Guaranteed accuracy of a solver kind: machine precision for direct ones, their own tolerance for iterative ones.
double promised(SolverKind kind) {
  return kind == SolverKind::kConjugateGradient ? 1e-6 : 1e-10;
}

double distance(const Eigen::MatrixXd& x, const Eigen::MatrixXd& truth) {
  return (x - truth).norm() / truth.norm();
}

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index cols, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [&] { return uniform(random); });
}

// A dense solver that counts the right-hand sides it is asked for.
struct Counter {
  int factorised = 0, solved = 0;
};
class CountingSolver final : public LinearSolver {
 public:
  explicit CountingSolver(Counter& counter) : counter_(counter), inner_(make_solver(SolverKind::kDense, 1)) {}
  std::string_view name() const override { return "counting"; }
  void analyse(const BlockMatrix& a) override { inner_->analyse(a); }
  bool factorise(const BlockMatrix& a) override { return ++counter_.factorised, inner_->factorise(a); }
  void solve(const Vector& b, Vector& x) const override { ++counter_.solved, inner_->solve(b, x); }
  void solve_many(Eigen::Ref<Rows> columns) const override {
    counter_.solved += static_cast<int>(columns.cols());
    inner_->solve_many(columns);
  }

 private:
  Counter& counter_;
  std::unique_ptr<LinearSolver> inner_;
};

// A moving finger: pulled by its device, bent, rotated.
struct Finger {
  Bar bar = make_finger(4, 2, 2, 0.01);
  SoftBody body;
  Handle6 handle;
  std::unique_ptr<SoftBodyState> state;

  Finger(Attachment attachment, std::unique_ptr<LinearSolver> solver) {
    body.rayleigh = {0.3, 2e-3};
    handle.attachment = attachment;
    handle.carried = false;  // the compensation is not part of the matrix
    const Pose placement{{0.1, 0.2, -0.1}, rotation_of({0.3, -0.5, 0.2})};
    state = std::make_unique<SoftBodyState>(bar.tets, bar.collision_mesh, body, &handle, placement, std::move(solver));
    const Pose there{{0.12, 0.21, -0.1}, rotation_of({0.6, -0.5, 0.9})};
    state->set_device(there, join({0.1, 0.05, 0}, {1, 2, 0}));
    for (int i = 0; i < 4; ++i) step();
  }
  void step() {
    state->free_step(kSchurStep, kSchurGravity);
    state->advance(kSchurStep);
  }
};

struct SchurSystem {
  Eigen::MatrixXd A;
  Vector b;
};

// The paper's matrices, whole and dense, from tissue whose nodes all have rows; at the state that a step begins with.
SchurSystem dense_system(const Finger& finger) {
  const SoftBodyState& state = *finger.state;
  const TetMesh& tets = finger.bar.tets;
  Tissue whole(tets, {.young = finger.body.young, .alpha = finger.body.rayleigh[0], .beta = finger.body.rayleigh[1]},
               tets.node_count());
  whole.position() = state.tissue().position();
  whole.velocity() = state.tissue().velocity();
  whole.assemble(kSchurStep, kSchurGravity);
  Eigen::MatrixXd tissue = whole.inner().dense();
  Vector right = whole.right();

  const Eigen::Index nodes = tissue.rows(), first = 3 * tets.free_count;
  SchurSystem out;
  if (finger.handle.attachment == Attachment::kSlave) {  // [v_t; v_h] = P [v_t; w]
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(nodes, first + 6);
    P.topLeftCorner(first, first).setIdentity();
    for (std::uint32_t i = 0; i < tets.handle_count; ++i)
      P.block<3, 6>(first + 3 * i, first) = grip_matrix(state.handle().arm(i));
    out = {P.transpose() * tissue * P, P.transpose() * right};
  } else {
    const double damped = 1 + kSchurStep * finger.body.rayleigh[0];
    const Matrix6 mass = state.handle().mass_matrix();
    out.A = Eigen::MatrixXd::Zero(nodes + 6, nodes + 6);
    out.A.topLeftCorner(nodes, nodes) = tissue;
    out.A.bottomRightCorner<6, 6>() = damped * mass;
    out.b = Vector::Zero(nodes + 6);
    out.b.head(nodes) = right;
    out.b.tail<6>() = mass * (state.handle().motion().velocity + kSchurStep * join(kSchurGravity, dvec3(0)));
    for (std::uint32_t i = 0; i < tets.handle_count; ++i) {
      const std::uint32_t node = tets.free_count + i;
      const double m = whole.mass()[node], k = kTieStiffness * finger.body.young * std::cbrt(m / finger.body.density);
      const double s = kSchurStep * 2 * std::sqrt(k * m) + kSchurStep * kSchurStep * k;
      const dvec3 ride = state.handle().motion().pose.position + state.handle().arm(i);
      const dvec3 e = whole.position()[node] - ride,
                  carried = m * (whole.velocity()[node] + kSchurStep * kSchurGravity);
      const Eigen::Vector3d pull = kSchurStep * k * Eigen::Vector3d(e.x, e.y, e.z);
      const Eigen::Index at = first + 3 * i;
      const Grip Gi = grip_matrix(whole.position()[node] - state.handle().motion().pose.position);
      out.A.block<3, 3>(at, at) += (s - damped * m) * Eigen::Matrix3d::Identity();
      out.A.block<3, 6>(at, nodes) -= s * Gi;
      out.A.block<6, 3>(nodes, at) -= s * Gi.transpose();
      out.A.bottomRightCorner<6, 6>() += s * Gi.transpose() * Gi;
      out.b.segment<3>(at) -= pull + Eigen::Vector3d(carried.x, carried.y, carried.z);
      out.b.tail<6>() += Gi.transpose() * pull;
    }
  }
  const RigidMotion motion = state.handle().motion(), device = state.device_target();
  const CouplingStep coupling =
      coupling_step(coupling_force(finger.handle, motion, device), motion, device, kSchurStep);
  out.A.diagonal().tail<6>() += coupling.matrix;
  out.b.tail<6>() += coupling.right;
  return out;
}

TEST(Schur, IsTheDenseSolutionForAnyBlocks) {
  // Three nodes in a row, the last two tied to the handle; A = X^T X + 1 where the pattern has blocks.
  BlockMatrix tt = make_pattern(3, {{0, 1, 1, 1}, {1, 2, 2, 2}});
  const Eigen::MatrixXd X = random_matrix(15, 15, 1);
  Eigen::MatrixXd A = X.transpose() * X + Eigen::MatrixXd::Identity(15, 15);
  A.block<3, 3>(0, 6).setZero(), A.block<3, 3>(6, 0).setZero();
  A.block<3, 6>(0, 9).setZero(), A.block<6, 3>(9, 0).setZero();
  A.diagonal().array() += 10;  // still positive definite with those blocks taken out
  for (std::uint32_t row = 0; row < 3; ++row)
    for (std::uint32_t k = tt.first[row]; k < tt.first[row + 1]; ++k)
      tt.value[k] = A.block<3, 3>(3 * row, 3 * tt.column[k]);
  const std::vector<HandleRow> th{{1, A.block<3, 6>(3, 9)}, {2, A.block<3, 6>(6, 9)}};
  const Vector b = random_matrix(15, 1, 2);
  const Eigen::MatrixXd columns = random_matrix(15, 5, 3);

  for (const SolverKind kind : available_solvers()) {
    CoupledSolver solver(make_solver(kind, 3), tt, true);
    Vector x = Vector::Zero(15);
    ASSERT_TRUE(solver.factorise(tt, th, A.bottomRightCorner<6, 6>(), b, x));
    EXPECT_LT(distance(x, A.ldlt().solve(b)), promised(kind)) << static_cast<int>(kind);
    Rows solved = columns;
    solver.solve(solved);
    EXPECT_LT(distance(solved, A.ldlt().solve(columns)), promised(kind)) << static_cast<int>(kind);
  }
}

TEST(Schur, FreeMotionAndSolvesOfATwoPartToolAreThoseOfItsWholeMatrixWithEverySolver) {
  for (const Attachment attachment : {Attachment::kSlave, Attachment::kSpring})
    for (const SolverKind kind : available_solvers()) {
      Finger finger(attachment, make_solver(kind, 200));
      const SchurSystem whole = dense_system(finger);
      const Eigen::LDLT<Eigen::MatrixXd> truth(whole.A);
      finger.state->free_step(kSchurStep, kSchurGravity);
      SCOPED_TRACE(testing::Message() << "attachment " << int(attachment) << ", solver " << int(kind));
      ASSERT_EQ(finger.state->size(), whole.b.size());
      EXPECT_LT(distance(finger.state->velocity(), truth.solve(whole.b)), promised(kind));

      const Eigen::MatrixXd columns = random_matrix(whole.b.size(), 6, 4);
      Rows solved = columns;
      finger.state->solve(solved);
      EXPECT_LT(distance(solved, truth.solve(columns)), promised(kind));
      const Eigen::MatrixXd inverse = whole.A.inverse();
      EXPECT_LT(distance(finger.state->reduced().inverse(), inverse.bottomRightCorner<6, 6>()), promised(kind));
    }
}

TEST(Schur, AStepTakesExactlySevenSolvesOfTheTissue) {
  for (const Attachment attachment : {Attachment::kSlave, Attachment::kSpring}) {
    Counter counter;
    Finger finger(attachment, std::make_unique<CountingSolver>(counter));
    counter = {};
    finger.state->free_step(kSchurStep, kSchurGravity);
    EXPECT_EQ(counter.factorised, 1);
    EXPECT_EQ(counter.solved, 7);
    Rows columns = random_matrix(finger.state->size(), 12, 5);
    finger.state->solve(columns);
    EXPECT_EQ(counter.solved, 7 + 12);
  }
}

TEST(Schur, ContactsSeeOneBodyWhetherItsPartsAreSolvedTogetherOrApart) {
  // P2's Delassus operator: J A^-1 J^T = J_t A_tt^-1 J_t^T + (J_h - J_t Z) S^-1 (J_h - J_t Z)^T.
  for (const Attachment attachment : {Attachment::kSlave, Attachment::kSpring}) {
    Finger finger(attachment, make_solver(SolverKind::kDense, 1));
    SoftBodyState& state = *finger.state;
    state.free_step(kSchurStep, kSchurGravity);
    const int points = 6, n = state.size();
    const dmat3 axes = glm::mat3_cast(rotation_of({0.2, 0.4, -0.7}));
    Rows together = Rows::Zero(n, 3 * points), hat = Rows::Zero(3 * points, 6);
    std::vector<SurfacePoint> point;
    for (int i = 0; i < points; ++i) {
      const auto count = static_cast<std::uint32_t>(finger.bar.collision_mesh.triangles.size());
      point.push_back({static_cast<std::uint32_t>(i) * count / points, {0.2, 0.5, 0.3}, {}});
      state.spread(point.back(), axes, i % 2 ? -1.0 : 1.0, together, 3 * i);
      state.handle_rows(point.back(), axes, i % 2 ? -1.0 : 1.0, hat.middleRows<3>(3 * i));
    }
    const Rows impulses = together;
    state.solve(together);
    const Eigen::MatrixXd W = impulses.transpose() * together;
    Rows apart = impulses.topRows(n - 6);
    state.solve_held(apart);
    const Eigen::MatrixXd parts = impulses.topRows(n - 6).transpose() * apart +
                                  hat * state.reduced().ldlt().solve(Eigen::MatrixXd(hat.transpose()));
    EXPECT_LT(distance(parts, W), 1e-10);
  }
}

TEST(Schur, WhatCannotBeFactorisedMovesNothing) {
  BlockMatrix tt = make_pattern(1, {{0, 0, 0, 0}});
  tt.value[0] = Block::Identity();
  CoupledSolver solver(make_solver(SolverKind::kDense, 1), tt, true);
  const std::vector<HandleRow> none;
  Vector x = Vector::Ones(9);
  const Vector b = Vector::Ones(9);
  EXPECT_TRUE(solver.factorise(tt, none, Matrix6::Identity(), b, x));
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    tt.value[0] = bad * Block::Identity();
    EXPECT_FALSE(solver.factorise(tt, none, Matrix6::Identity(), b, x));
    Rows columns = Rows::Ones(9, 2);
    solver.solve(columns);
    EXPECT_EQ(x.norm() + columns.norm(), 0.0);
  }
  tt.value[0] = Block::Identity();
  EXPECT_FALSE(solver.factorise(tt, none, -Matrix6::Identity(), b, x));
  EXPECT_EQ(x.norm(), 0.0);
}

}  // namespace
}  // namespace pliant
