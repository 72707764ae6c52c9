// Interface of linear solvers (P2: black boxes): factorise, then solve any number of times. Callers are independent of
// the library or method.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "components/built_in.h"
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
  // [m] positions of the block rows' nodes, for methods that use them (rigid motions of neighbourhoods): once, and
  // again before factorise() when they have moved.
  virtual void place(const std::vector<dvec3>& nodes) { (void)nodes; }
  // Values of an analysed pattern. False: not positive definite; solve() must not be called then.
  [[nodiscard]] virtual bool factorise(const BlockMatrix& a) = 0;
  // x = A^-1 b. On entry x is the initial guess (for iterative methods; others ignore it).
  virtual void solve(const Vector& b, Vector& x) const = 0;
  // columns = A^-1 columns, in place, all right-hand sides at once. `columns` may be the upper rows of a larger matrix:
  // a coupled solve passes the tissue's part without a copy.
  virtual void solve_many(Eigen::Ref<Rows> columns) const = 0;
  // gram = B^T A^-1 B, symmetric: the mutual response of B's columns. Solves for all of them, unless a method has a
  // shortcut.
  virtual void solve_gram(const BlockColumns& b, Eigen::MatrixXd& gram) const;
  // out = A^-1 B mix, B of the last solve_gram since factorise(), by what that has kept of the solution. False:
  // nothing.
  [[nodiscard]] virtual bool solve_kept(const ColumnMix& mix, Eigen::Ref<Rows> out) const {
    (void)mix, (void)out;
    return false;
  }
};

// Of each solver that ships, in its own file (components/built_in.h). Null if the build lacks it.
#define PLIANT_SOLVER(word, ...) std::unique_ptr<LinearSolver> make_##word(std::uint32_t block_rows);
PLIANT_SOLVERS(PLIANT_SOLVER)
#undef PLIANT_SOLVER

// Null if the build lacks that kind, or its factory returned nothing.
std::unique_ptr<LinearSolver> make_solver(SolverKind kind, std::uint32_t block_rows);
std::vector<SolverKind> available_solvers();  // that ship, but `auto`

}  // namespace pliant
