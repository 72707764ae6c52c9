#include "systems/tool/linear_solver.h"

#include "systems/tool/block_cholesky.h"
#include "systems/tool/dense_solver.h"
#include "systems/tool/eigen_cholesky.h"

namespace pliant {

std::unique_ptr<LinearSolver> make_solver(SolverKind kind, std::uint32_t) {
  switch (kind) {
    case SolverKind::kDense:
      return std::make_unique<DenseSolver>();
    case SolverKind::kAuto:
    case SolverKind::kBlockCholesky:
      return std::make_unique<BlockCholesky>();
    case SolverKind::kEigenCholesky:
      return std::make_unique<EigenCholesky>();
    default:
      return nullptr;
  }
}

std::vector<SolverKind> available_solvers() {
  std::vector<SolverKind> kinds;
  for (const SolverKind kind : {SolverKind::kBlockCholesky, SolverKind::kEigenCholesky, SolverKind::kCholmod,
                                SolverKind::kConjugateGradient, SolverKind::kDense})
    if (make_solver(kind, 1) != nullptr) kinds.push_back(kind);
  return kinds;
}

}  // namespace pliant
