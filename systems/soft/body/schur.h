// The coupled solve of P2 (methods.md 2.4): tissue and handle behind black boxes.
//   [A_tt  A_th] [v]   [b_t]      y = A_tt^-1 b_t,  Z = A_tt^-1 A_th  (seven solves),
//   [A_ht  A_hh] [w] = [b_h]      S = A_hh - A_ht Z,  w = S^-1 (b_h - A_ht y),  v = y - Z w.
// Vectors and columns contain the tissue's degrees of freedom first and the handle's six last. The tissue's solver only
// needs factorise and solve. Without a handle this reduces to that solver. Further rigid parts (rigid_parts.h) count as
// tissue here: six rows each, after those of the nodes.
#pragma once

#include <Eigen/Cholesky>
#include <memory>
#include <vector>

#include "systems/soft/body/handle.h"
#include "systems/soft/linear/linear_solver.h"

namespace pliant {

// Coupling of a node to the handle: rows 3 node .. 3 node + 2 of A_th. Of a rigid part: two of these, after the nodes.
struct HandleRow {
  std::uint32_t node = 0;
  Grip value = Grip::Zero();
};

class CoupledSolver {
 public:
  // `parts`: rows of rigid parts, of `tissue`'s solutions after those of `pattern`.
  CoupledSolver(std::unique_ptr<LinearSolver> tissue, const BlockMatrix& pattern, bool handle, Eigen::Index parts = 0);

  void place(const std::vector<dvec3>& nodes) { tissue_->place(nodes); }  // LinearSolver::place
  // Factorises and solves for the first right-hand side: x = A^-1 b; x is the initial guess on entry. False: A is not
  // positive definite or not finite; then x is zero, and so is every solution until the next success.
  [[nodiscard]] bool factorise(const BlockMatrix& tt, const std::vector<HandleRow>& th, const Matrix6& hh,
                               const Vector& b, Vector& x);
  void solve(Rows& columns) const;                  // columns = A^-1 columns
  void solve_held(Eigen::Ref<Rows> columns) const;  // columns = A_tt^-1 columns: tissue alone, the handle fixed

  // gram = B^T A_tt^-1 B: tissue alone, the handle fixed. B: of tissue.
  void gram_held(const BlockColumns& b, Eigen::MatrixXd& gram) const;
  // out = A_tt^-1 B mix, B of the last gram_held (LinearSolver::solve_kept).
  [[nodiscard]] bool solve_kept(const ColumnMix& mix, Eigen::Ref<Rows> out) const {
    return solvable_ && tissue_->solve_kept(mix, out);
  }
  // J A^-1 J^T = J_t A_tt^-1 J_t^T + lever lever^T. `moved`: J follow(), rows x 6.
  Rows lever(const Rows& moved) const;

  Eigen::Index size() const { return tissue_rows_ + handle_rows_; }
  const Matrix6& reduced() const { return reduced_; }  // S [kg]
  // [-Z; 1], size() x 6: motion of the whole tool when the handle is moved and tissue follows.
  const Rows& follow() const { return follow_; }
  // b_h - A_ht y of the last factorise: right-hand side of the handle with the tissue eliminated.
  const Vector6& reduced_right() const { return reduced_right_; }

 private:
  void solve_seven(const Matrix6& hh, const Vector& b, Vector& x);

  std::unique_ptr<LinearSolver> tissue_;
  Eigen::Index tissue_rows_ = 0, handle_rows_ = 0;
  bool solvable_ = false;
  std::vector<HandleRow> border_;
  Matrix6 reduced_ = Matrix6::Identity();
  Eigen::LLT<Matrix6> factor_;
  Vector6 reduced_right_ = Vector6::Zero();
  Rows follow_, seven_;
};

}  // namespace pliant
