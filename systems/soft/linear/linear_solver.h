// The seam behind which linear systems are solved (P2: black boxes): factorise, then solve as often as you like.
// Nothing above it knows which library or method does the work.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "components/math.h"
#include "pliant/parameters.h"
#include "systems/soft/linear/block_columns.h"

namespace pliant {

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  virtual std::string_view name() const = 0;
  // Once per pattern; `a` must outlive the solver's use.
  virtual void analyse(const BlockMatrix& a) = 0;
  // [m] where the nodes of the block rows stand, for methods that use it (rigid motions of neighbourhoods): once, and
  // again before factorise() when they have moved.
  virtual void place(const std::vector<dvec3>& nodes) { (void)nodes; }
  // Numbers of an analysed pattern. False: not positive definite; solve() must not be called then.
  [[nodiscard]] virtual bool factorise(const BlockMatrix& a) = 0;
  // x = A^-1 b. x comes in as a guess (iterative methods start there; others ignore it).
  virtual void solve(const Vector& b, Vector& x) const = 0;
  // columns = A^-1 columns, in place, all right-hand sides at once. The upper rows of a larger matrix will do: a
  // coupled solve hands over the tissue's part of its columns without copying them.
  virtual void solve_many(Eigen::Ref<Rows> columns) const = 0;
  // gram = B^T A^-1 B, symmetric: how B's columns move what they themselves push. Solves for all of them, unless a
  // method has something shorter.
  virtual void solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const;
};

// Null where the build does not have that kind, or its factory made nothing.
std::unique_ptr<LinearSolver> make_solver(SolverKind kind, std::uint32_t block_rows);
std::vector<SolverKind> available_solvers();

}  // namespace pliant
