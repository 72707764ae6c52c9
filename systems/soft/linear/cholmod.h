// SuiteSparse's supernodal Cholesky factor (CHOLMOD), for comparison. Its supernodal part is under the GPL, so it is
// only in builds that request it (-DPLIANT_CHOLMOD=ON, Debian's libsuitesparse-dev).
#pragma once
#ifdef PLIANT_CHOLMOD

#include <suitesparse/cholmod.h>

#include "systems/soft/linear/linear_solver.h"

namespace pliant {

class Cholmod final : public LinearSolver {
 public:
  Cholmod();
  ~Cholmod() override;
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  std::string_view name() const override { return "cholmod"; }
  void analyse(const BlockMatrix& a) override;
  bool factorise(const BlockMatrix& a) override;
  void solve(const Vector& b, Vector& x) const override;
  void solve_many(Eigen::Ref<Rows> columns) const override;

 private:
  void release();

  mutable cholmod_common common_;
  cholmod_sparse* lower_ = nullptr;
  cholmod_factor* factor_ = nullptr;
};

}  // namespace pliant
#endif
