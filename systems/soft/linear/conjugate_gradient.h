// Preconditioned conjugate gradients for large bodies: an incomplete Cholesky factor, then a correction of its
// remainder by rigid motions of neighbourhoods,
//   z = M r,  z += P (P^T A P)^-1 P^T (r - A z)        (A-DEF2: Tang, Nabben, Vuik, Erlangga 2009),
// M and its products in single precision, the iteration in double. Iterations to 1e-6 of the direct solution, clamped
// beam, nu = 0.45, a step of 10 ms, at 2,100 / 10k / 40k tetrahedra: block Jacobi 140 / 235 / 350, incomplete Cholesky
// alone 30 / 49 / 74, with the correction 12 / 14 / 16. A stale exact factor took 6 in the next step, but 15 after four
// steps and 37 after eight.
// factorise() detects only matrices whose diagonal blocks or coarse part are not positive definite. Others that are not
// end with a residual that does not fall (iterations() is then kMostIterations).
#pragma once

#include "systems/soft/linear/incomplete_cholesky.h"
#include "systems/soft/linear/linear_solver.h"
#include "systems/soft/linear/rigid_coarse.h"

namespace pliant {

class ConjugateGradient final : public LinearSolver {
 public:
  static constexpr int kMostIterations = 500;

  std::string_view name() const override { return "conjugate-gradient"; }
  void analyse(const BlockMatrix& a) override;
  void place(const std::vector<dvec3>& nodes) override { position_ = nodes; }
  bool factorise(const BlockMatrix& a) override;
  void solve(const Vector& b, Vector& x) const override;
  void solve_many(Eigen::Ref<Rows> columns) const override;

  int iterations() const { return iterations_; }  // of the last solve(); of solve_many() the most of its columns
  bool converged() const { return iterations_ < kMostIterations; }
  // [1] of the solution: stop when the next correction is smaller. The error was up to three times that.
  double tolerance = 1e-9;

 private:
  struct Work {  // four numbers per node
    std::vector<double> b, x, r, z, p, q;
    std::vector<float> r_single, z_single, q_single;
  };
  void precondition() const;  // work_.z from work_.r
  void residual() const;      // work_.r = b - A x

  HalfPattern pattern_;
  HalfMatrix<double> matrix_;
  HalfMatrix<float> single_;
  IncompleteCholesky incomplete_;
  RigidCoarse coarse_;
  std::vector<dvec3> position_;
  mutable Work work_;
  mutable int iterations_ = 0;
};

}  // namespace pliant
