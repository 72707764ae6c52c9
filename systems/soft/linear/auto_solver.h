// Conjugate gradients for one or two right-hand sides, a factor for many. Each step begins with the method that would
// have been best for the last one; the other takes over if the prediction was wrong. Measured on one core, clamped
// beams of 160 / 504 / 2,106 / 7,774 nodes (540 / 2,100 / 10k / 40k tetrahedra), a step of 10 ms, ms:
//   factorise and solve one:          0.25 /  2.1 /   49 /   725
//   conjugate gradients to 1e-9, one: 0.23 /  0.9 /  5.3 /    27   (bench/soft_solver.cpp)
#pragma once

#include "systems/soft/linear/block_cholesky.h"
#include "systems/soft/linear/conjugate_gradient.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {

class AutoSolver final : public LinearSolver {
 public:
  std::string_view name() const override { return "auto"; }
  void analyse(const BlockMatrix& a) override;
  void place(const std::vector<dvec3>& nodes) override { iterative_.place(nodes); }
  bool factorise(const BlockMatrix& a) override;
  void solve(const Vector& b, Vector& x) const override;
  void solve_many(Eigen::Ref<Rows> columns) const override;
  void solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const override;
  bool solve_kept(const ColumnMix& mix, Eigen::Ref<Rows> out) const override;

 private:
  bool better_direct(double columns) const;
  bool have_factor() const;
  bool have_iterative() const;

  const BlockMatrix* matrix_ = nullptr;
  mutable BlockCholesky direct_;
  mutable ConjugateGradient iterative_;
  mutable bool direct_ready_ = false, iterative_ready_ = false;
  mutable double columns_ = 0;  // solved for since factorise()
};

}  // namespace pliant
