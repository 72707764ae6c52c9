// A + U U^T for a few columns U, by the solver of A (Woodbury): with Z = A^-1 U and S = 1 + U^T Z,
//   (A + U U^T)^-1 = A^-1 - Z S^-1 Z^T.
#pragma once

#include <Eigen/Cholesky>

#include "systems/soft/linear/linear_solver.h"

namespace pliant {

class LowRankSolver final : public LinearSolver {
 public:
  // `columns`: U, read by every factorise(); outlives it.
  LowRankSolver(std::unique_ptr<LinearSolver> solver, const Rows& columns)
      : solver_(std::move(solver)), columns_(columns) {}

  std::string_view name() const override { return solver_->name(); }
  void analyse(const BlockMatrix& a) override { solver_->analyse(a); }
  void place(const std::vector<dvec3>& nodes) override { solver_->place(nodes); }
  [[nodiscard]] bool factorise(const BlockMatrix& a) override;
  void solve(const Vector& b, Vector& x) const override;
  void solve_many(Eigen::Ref<Rows> columns) const override;
  void solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const override;

 private:
  std::unique_ptr<LinearSolver> solver_;
  const Rows& columns_;  // U
  Rows z_;               // Z
  Eigen::LLT<Eigen::MatrixXd> small_;
};

}  // namespace pliant
