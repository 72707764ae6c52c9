#include "systems/soft/linear/linear_solver.h"

#include "components/registered.h"
#include "runtime/assert.h"
#include "systems/soft/linear/registered_solver.h"

namespace pliant {

std::unique_ptr<LinearSolver> make_solver(SolverKind kind, std::uint32_t block_rows) {
  if (const SolverFactory* factory = registered_solver(kind)) return make_registered(*factory);
#define PLIANT_SOLVER(word, ...) make_##word,
  constexpr std::unique_ptr<LinearSolver> (*kMake[])(std::uint32_t) = {PLIANT_SOLVERS(PLIANT_SOLVER)};
#undef PLIANT_SOLVER
  const auto place = static_cast<std::size_t>(kind);
  ASSERT(place < std::size(kMake));
  return kMake[place](block_rows);
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
  for (std::size_t i = 0; i < std::size(kSolverRows); ++i) {
    const auto kind = static_cast<SolverKind>(i);
    if (kind != SolverKind::kAuto && make_solver(kind, 1) != nullptr) kinds.push_back(kind);
  }
  return kinds;
}

}  // namespace pliant
