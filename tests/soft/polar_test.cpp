// The rotation in a deformation gradient against a singular value decomposition with a sign flip.
#include "systems/soft/fem/polar.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "systems/soft/body/rotation_vector.h"

namespace pliant {
namespace {

Eigen::Matrix3d to_eigen(const dmat3& m) {
  Eigen::Matrix3d out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out(r, c) = m[c][r];
  return out;
}

// The slower reference. `gap`: s2 + s3 of the signed singular values over s1: how well F determines the rotation.
Eigen::Matrix3d by_svd(const dmat3& F, double& gap) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(to_eigen(F), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) = -U.col(2);  // the smallest
  const Eigen::Vector3d s = (U.transpose() * to_eigen(F) * svd.matrixV()).diagonal();
  gap = (s[1] + s[2]) / s[0];
  return U * svd.matrixV().transpose();
}

double difference(const dmat3& F, const dquat& q, double& gap) {
  const Eigen::Matrix3d twin = by_svd(F, gap);
  return (to_eigen(mat3_cast(q)) - twin).norm();
}

class MatrixDice {
 public:
  double normal() { return normal_(random_); }
  dmat3 matrix() {
    dmat3 m;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) m[c][r] = normal();
    return m;
  }
  dquat turn() { return normalize(dquat(normal(), normal(), normal(), normal())); }

 private:
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

TEST(Polar, AgreesWithTheFlippedDecompositionOnAnyMatrixFromAnyGuess) {
  MatrixDice dice;
  int inverted = 0;
  for (int i = 0; i < 100000; ++i) {
    const dmat3 F = dice.matrix() * std::pow(10.0, dice.normal());
    if (determinant(F) < 0) ++inverted;
    dquat q = dice.turn();
    extract_rotation(F, q);
    double gap;
    const double error = difference(F, q, gap);
    ASSERT_NEAR(length(q), 1, 1e-14);
    ASSERT_LT(error * gap, 1e-12) << i << " gap " << gap;
  }
  EXPECT_GT(inverted, 40000);
}

TEST(Polar, FollowsStepsOfASimulationToRounding) {
  MatrixDice dice;
  dquat q(1, 0, 0, 0), truth(1, 0, 0, 0);
  for (int i = 0; i < 20000; ++i) {
    truth = normalize(truth * rotation_of(0.1 * dvec3(dice.normal(), dice.normal(), dice.normal())));
    dmat3 S(1);
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r <= c; ++r) S[r][c] = S[c][r] = (r == c) + 0.1 * dice.normal();
    extract_rotation(mat3_cast(truth) * S, q);
    ASSERT_LT((to_eigen(mat3_cast(q)) - to_eigen(mat3_cast(truth))).norm(), 1e-14 * 40) << i;
  }
}

TEST(Polar, TheTwinFromHornsMatrixAgreesToo) {
  MatrixDice dice;
  for (int i = 0; i < 20000; ++i) {
    const dmat3 F = dice.matrix();
    dquat q = dice.turn();
    extract_rotation_globally(F, q);
    double gap;
    const double error = difference(F, q, gap);
    ASSERT_LT(error * gap, 1e-12) << i;
  }
}

// Flat in one direction, the solution is still unique; flat in two, the rotation about the axis is the guess's; a point
// gives the guess.
TEST(Polar, CollapsedMatricesKeepWhatTheGuessKnew) {
  MatrixDice dice;
  for (int i = 0; i < 2000; ++i) {
    const dquat truth = dice.turn();
    const dmat3 R = mat3_cast(truth);
    const auto collapse = [&](dvec3 s) { return R * dmat3(s.x, 0, 0, 0, s.y, 0, 0, 0, s.z); };
    dquat q = dice.turn();
    extract_rotation(collapse({1.0, 0.6, 0.0}), q);
    EXPECT_LT(length(mat3_cast(q)[0] - R[0]) + length(mat3_cast(q)[1] - R[1]), 1e-13);

    const dquat near = truth * rotation_of({0.3, 0.0, 0.0});  // turned about the line that is left
    q = near;
    extract_rotation(collapse({1.0, 0.0, 0.0}), q);
    EXPECT_NEAR(std::abs(dot(q, near)), 1, 1e-13);

    q = near;
    extract_rotation(dmat3(0), q);
    EXPECT_EQ(std::abs(dot(q, near)) > 1 - 1e-15, true);
  }
}

TEST(Polar, AThinInvertedElementIsPushedOutThroughItsThinSide) {
  // A reflected sheet: the nearest rotation flips only the thin direction.
  dquat q(1, 0, 0, 0);
  const dmat3 F(1, 0, 0, 0, -0.05, 0, 0, 0, 1);
  extract_rotation(F, q);
  EXPECT_NEAR(q.w, 1, 1e-14);
}

}  // namespace
}  // namespace pliant
