#include "systems/soft/linear/auto_solver.h"

namespace pliant {
namespace {

// [ns] as measured (auto_solver.h)
constexpr double kPerFlop = 0.08, kPerFrontNode = 1000.0;       // of a factor
constexpr double kPerColumnNode = 2000.0, kPerSetupNode = 500;  // of conjugate gradients

}  // namespace

void AutoSolver::analyse(const BlockMatrix& a) {
  matrix_ = &a;
  direct_.analyse(a);
  iterative_.analyse(a);
  columns_ = 1;
}

bool AutoSolver::better_direct(double columns) const {
  const double nodes = matrix_->size;
  return kPerFlop * direct_.flops() + kPerFrontNode * nodes < (kPerColumnNode * columns + kPerSetupNode) * nodes;
}

bool AutoSolver::factorise(const BlockMatrix& a) {
  matrix_ = &a;
  direct_ready_ = iterative_ready_ = false;
  const bool direct = better_direct(columns_);
  columns_ = 0;
  return direct ? have_factor() : have_iterative() || have_factor();
}

bool AutoSolver::have_factor() const {
  if (!direct_ready_) direct_ready_ = direct_.factorise(*matrix_);
  return direct_ready_;
}

bool AutoSolver::have_iterative() const {
  if (!iterative_ready_) iterative_ready_ = iterative_.factorise(*matrix_);
  return iterative_ready_;
}

void AutoSolver::solve(const Vector& b, Vector& x) const {
  columns_ += 1;
  if (direct_ready_) return direct_.solve(b, x);
  iterative_.solve(b, x);
  if (!iterative_.converged() && have_factor()) direct_.solve(b, x);
}

void AutoSolver::solve_many(Eigen::Ref<Rows> columns) const {
  const auto count = static_cast<double>(columns.cols());
  columns_ += count;
  if (direct_ready_ || (better_direct(count) && have_factor())) return direct_.solve_many(columns);
  iterative_.solve_many(columns);
}

void AutoSolver::solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const {
  const auto count = 3.0 * static_cast<double>(b.count());
  columns_ += count;
  if (direct_ready_ || (better_direct(count) && have_factor())) return direct_.solve_gram(b, gram);
  iterative_.solve_gram(b, gram);
}

bool AutoSolver::solve_kept(const ColumnMix& mix, Eigen::Ref<Rows> out) const {
  columns_ += static_cast<double>(mix.count());
  return direct_ready_ && direct_.solve_kept(mix, out);
}

// Small systems are always factorised: conjugate gradients are not faster there (auto_solver.h), and a factor is exact.
std::unique_ptr<LinearSolver> make_auto(std::uint32_t block_rows) {
  constexpr std::uint32_t kSmall = 400;  // block rows
  if (block_rows > kSmall) return std::make_unique<AutoSolver>();
  return std::make_unique<BlockCholesky>();
}

}  // namespace pliant
