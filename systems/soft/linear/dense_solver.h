// Reference for tests of other solvers: a dense Cholesky factor, O(n^3).
#pragma once

#include <Eigen/Cholesky>

#include "systems/soft/linear/linear_solver.h"

namespace pliant {

class DenseSolver final : public LinearSolver {
 public:
  std::string_view name() const override { return "dense"; }
  void analyse(const BlockMatrix&) override {}
  bool factorise(const BlockMatrix& a) override;
  void solve(const Vector& b, Vector& x) const override { x = factor_.solve(b); }
  void solve_many(Eigen::Ref<Rows> columns) const override { columns = factor_.solve(columns).eval(); }

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace pliant
