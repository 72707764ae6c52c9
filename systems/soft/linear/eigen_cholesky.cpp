#include "systems/soft/linear/eigen_cholesky.h"

namespace pliant {

void EigenCholesky::analyse(const BlockMatrix& a) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(9 * a.value.size());
  for (std::uint32_t col = 0; col < a.size; ++col)
    for (std::uint32_t k = a.diagonal[col]; k < a.first[col + 1]; ++k)
      for (std::uint32_t i = 0; i < 3; ++i)
        for (std::uint32_t j = 0; j < 3; ++j) entries.emplace_back(3 * a.column[k] + i, 3 * col + j, 1.0);
  lower_.resize(3 * a.size, 3 * a.size);
  lower_.setFromTriplets(entries.begin(), entries.end());
  factor_.analyzePattern(lower_);
}

bool EigenCholesky::factorise(const BlockMatrix& a) {
  // Column c of A is row c, since A is symmetric; columns 3c, 3c+1, 3c+2 take three numbers of each block in turn.
  for (std::uint32_t col = 0; col < a.size; ++col)
    for (int j = 0; j < 3; ++j) {
      double* out = lower_.valuePtr() + lower_.outerIndexPtr()[3 * col + j];
      for (std::uint32_t k = a.diagonal[col]; k < a.first[col + 1]; ++k)
        for (int i = 0; i < 3; ++i) *out++ = a.value[k](j, i);
    }
  factor_.factorize(lower_);
  if (factor_.info() != Eigen::Success) return false;
  const Eigen::ArrayXd pivots = factor_.vectorD();
  return (pivots > 0).all() && pivots.isFinite().all();
}

void EigenCholesky::solve_many(Eigen::Ref<Rows> columns) const {
  const Eigen::MatrixXd right = columns;
  columns = factor_.solve(right);
}

std::unique_ptr<LinearSolver> make_eigen_cholesky(std::uint32_t) {
  return std::make_unique<EigenCholesky>();
}

}  // namespace pliant
