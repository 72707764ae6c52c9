#include "systems/soft/linear/dense_solver.h"

namespace pliant {

bool DenseSolver::factorise(const BlockMatrix& a) {
  factor_.compute(a.dense());
  return factor_.info() == Eigen::Success && factor_.matrixLLT().diagonal().allFinite();
}

std::unique_ptr<LinearSolver> make_dense(std::uint32_t) {
  return std::make_unique<DenseSolver>();
}

}  // namespace pliant
