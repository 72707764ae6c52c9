// Eigen's SimplicialLDLT (approximate minimum degree order, column by column): a slower reference from a library.
#pragma once

#include <Eigen/SparseCholesky>

#include "systems/soft/linear/linear_solver.h"

namespace pliant {

class EigenCholesky final : public LinearSolver {
 public:
  std::string_view name() const override { return "eigen-cholesky"; }
  void analyse(const BlockMatrix& a) override;
  bool factorise(const BlockMatrix& a) override;
  void solve(const Vector& b, Vector& x) const override { x = factor_.solve(b); }
  void solve_many(Eigen::Ref<Rows> columns) const override;

 private:
  Eigen::SparseMatrix<double> lower_;  // the matrix without the part above its diagonal blocks
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factor_;
};

}  // namespace pliant
