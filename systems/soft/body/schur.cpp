#include "systems/soft/body/schur.h"

#include "runtime/assert.h"

namespace pliant {

CoupledSolver::CoupledSolver(std::unique_ptr<LinearSolver> tissue, const BlockMatrix& pattern, bool handle,
                             Eigen::Index parts)
    : tissue_(std::move(tissue)),
      tissue_rows_(3 * static_cast<Eigen::Index>(pattern.size) + parts),
      handle_rows_(handle ? 6 : 0) {
  ASSERT(tissue_ != nullptr);
  tissue_->analyse(pattern);
  follow_ = Rows::Zero(size(), handle_rows_);
  if (handle) follow_.bottomRows<6>().setIdentity();
}

bool CoupledSolver::factorise(const BlockMatrix& tt, const std::vector<HandleRow>& th, const Matrix6& hh,
                              const Vector& b, Vector& x) {
  ASSERT(b.size() == size() && x.size() == size());
  border_ = th;
  solvable_ = tissue_->factorise(tt) && b.allFinite();
  if (solvable_) handle_rows_ == 0 ? tissue_->solve(b, x) : solve_seven(hh, b, x);
  solvable_ = solvable_ && x.allFinite();
  if (!solvable_) x.setZero();
  return solvable_;
}

// y and Z in one pass, S and w.
void CoupledSolver::solve_seven(const Matrix6& hh, const Vector& b, Vector& x) {
  seven_.setZero(tissue_rows_, 7);
  seven_.col(0) = b.head(tissue_rows_);
  for (const HandleRow& row : border_) seven_.block<3, 6>(3 * row.node, 1) = row.value;
  tissue_->solve_many(seven_);

  follow_.topRows(tissue_rows_) = -seven_.rightCols<6>();
  reduced_ = hh;
  reduced_right_ = b.tail<6>();
  for (const HandleRow& row : border_) {
    reduced_ += row.value.transpose() * follow_.middleRows<3>(3 * row.node);
    reduced_right_ -= row.value.transpose() * seven_.block<3, 1>(3 * row.node, 0);
  }
  reduced_ = (0.5 * (reduced_ + reduced_.transpose())).eval();
  factor_.compute(reduced_);
  solvable_ = factor_.info() == Eigen::Success;
  if (!solvable_) return;

  x.head(tissue_rows_) = seven_.col(0);
  x.tail<6>().setZero();
  x.noalias() += follow_ * factor_.solve(reduced_right_);
}

void CoupledSolver::solve(Rows& columns) const {
  ASSERT(columns.rows() == size());
  if (!solvable_) columns.setZero();
  solve_held(columns.topRows(tissue_rows_));
  if (handle_rows_ == 0 || !solvable_) return;
  Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> w = columns.bottomRows<6>();
  for (const HandleRow& row : border_) w.noalias() -= row.value.transpose() * columns.middleRows<3>(3 * row.node);
  factor_.solveInPlace(w);
  columns.bottomRows<6>().setZero();
  columns.noalias() += follow_ * w;
}

void CoupledSolver::solve_held(Eigen::Ref<Rows> columns) const {
  ASSERT(columns.rows() == tissue_rows_);
  if (solvable_)
    tissue_->solve_many(columns);
  else
    columns.setZero();
}

void CoupledSolver::gram_held(const BlockColumns& b, Eigen::MatrixXd& gram) const {
  ASSERT(3 * static_cast<Eigen::Index>(b.size) == tissue_rows_);
  if (solvable_)
    tissue_->solve_gram(b, gram);
  else
    gram.setZero(3 * b.count(), 3 * b.count());
}

Rows CoupledSolver::lever(const Rows& moved) const {
  if (!solvable_) return Rows::Zero(moved.rows(), 6);
  return factor_.matrixL().solve(moved.transpose()).transpose();
}

}  // namespace pliant
