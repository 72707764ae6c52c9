#include "systems/soft/linear/sparse_lu.h"

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

namespace pliant {
namespace {

constexpr double kFillIn = 2.0;  // [1] multiplications over the sum of squared column counts, for a pile's system

}  // namespace

bool solve_sparse_lu(const std::vector<double>& a, int n, double* x, double& work) {
  Eigen::SparseMatrix<double> matrix(n, n);
  const Eigen::Map<const Eigen::MatrixXd> dense(a.data(), n, n);
  Eigen::VectorXi held = (dense.array() != 0.0).cast<int>().colwise().sum();
  const double cost = kFillIn * held.cast<double>().squaredNorm();
  const bool affordable = cost <= work;
  work = cost;
  if (!affordable) return false;
  matrix.reserve(held);
  for (int c = 0; c < n; ++c)
    for (int r = 0; r < n; ++r)
      if (dense(r, c) != 0.0) matrix.insert(r, c) = dense(r, c);
  matrix.makeCompressed();
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(matrix);
  if (lu.info() != Eigen::Success) return false;
  Eigen::Map<Eigen::VectorXd> solution(x, n);
  solution = lu.solve(solution).eval();
  return true;
}

}  // namespace pliant
