#include "systems/soft/linear/linear_solver.h"

#include "components/registered.h"
#include "runtime/assert.h"
#include "systems/soft/linear/auto_solver.h"
#include "systems/soft/linear/block_cholesky.h"
#include "systems/soft/linear/cholmod.h"
#include "systems/soft/linear/conjugate_gradient.h"
#include "systems/soft/linear/dense_solver.h"
#include "systems/soft/linear/eigen_cholesky.h"
#include "systems/soft/linear/registered_solver.h"

namespace pliant {

// Small systems are always factorised: conjugate gradients are not faster there (auto_solver.h), and a factor is exact.
constexpr std::uint32_t kSmall = 400;  // block rows

std::unique_ptr<LinearSolver> make_solver(SolverKind kind, std::uint32_t block_rows) {
  if (const SolverFactory* factory = registered_solver(kind)) return make_registered(*factory);
  switch (kind) {
    case SolverKind::kDense:
      return std::make_unique<DenseSolver>();
    case SolverKind::kAuto:
      if (block_rows > kSmall) return std::make_unique<AutoSolver>();
      return std::make_unique<BlockCholesky>();
    case SolverKind::kBlockCholesky:
      return std::make_unique<BlockCholesky>();
    case SolverKind::kEigenCholesky:
      return std::make_unique<EigenCholesky>();
    case SolverKind::kCholmod:
#ifdef PLIANT_CHOLMOD
      return std::make_unique<Cholmod>();
#else
      return nullptr;
#endif
    case SolverKind::kConjugateGradient:
      return std::make_unique<ConjugateGradient>();
  }
  UNREACHABLE();
}

void LinearSolver::solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const {
  Rows x = Rows::Zero(3 * static_cast<Eigen::Index>(b.size), 3 * b.count());
  for (Eigen::Index i = 0; i < b.count(); ++i)
    for (const BlockColumns::Entry& entry : b.of(i)) x.block<3, 3>(3 * entry.row, 3 * i) += entry.value;
  solve_many(x);
  gram.setZero(3 * b.count(), 3 * b.count());
  for (Eigen::Index i = 0; i < b.count(); ++i)
    for (const BlockColumns::Entry& entry : b.of(i))
      gram.middleRows<3>(3 * i).noalias() += entry.value.transpose() * x.middleRows<3>(3 * entry.row);
  gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
}

std::vector<SolverKind> available_solvers() {
  std::vector<SolverKind> kinds;
  for (const SolverKind kind : {SolverKind::kBlockCholesky, SolverKind::kEigenCholesky, SolverKind::kCholmod,
                                SolverKind::kConjugateGradient, SolverKind::kDense})
    if (make_solver(kind, 1) != nullptr) kinds.push_back(kind);
  return kinds;
}

}  // namespace pliant
