#include "systems/soft/linear/low_rank_solver.h"

namespace pliant {

bool LowRankSolver::factorise(const BlockMatrix& a) {
  if (!solver_->factorise(a)) return false;
  z_ = columns_;
  solver_->solve_many(z_);
  small_.compute(Eigen::MatrixXd::Identity(z_.cols(), z_.cols()) + columns_.transpose() * z_);
  return small_.info() == Eigen::Success;
}

void LowRankSolver::solve(const Vector& b, Vector& x) const {
  solver_->solve(b, x);
  x -= z_ * small_.solve(columns_.transpose() * x);
}

void LowRankSolver::solve_many(Eigen::Ref<Rows> columns) const {
  solver_->solve_many(columns);
  const Eigen::MatrixXd share = small_.solve(columns_.transpose() * columns);
  columns.noalias() -= z_ * share;
}

void LowRankSolver::solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const {
  solver_->solve_gram(b, gram);
  Rows moved = Rows::Zero(3 * b.count(), z_.cols());  // B^T Z
  for (Eigen::Index c = 0; c < b.count(); ++c)
    for (const BlockColumns::Entry& entry : b.of(c))
      moved.middleRows<3>(3 * c).noalias() += entry.value.transpose() * z_.middleRows<3>(3 * entry.row);
  gram.noalias() -= moved * small_.solve(Eigen::MatrixXd(moved.transpose()));
  gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
}

}  // namespace pliant
