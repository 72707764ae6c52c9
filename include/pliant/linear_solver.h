// A linear solver of one's own for soft bodies (P2: black boxes): derive, register under a name, and use what
// registering returns in SoftBodyParameters::solver, or the name in a level file (`solver`).
//
// One instance serves one body. It is made when a session opens and called by the soft clock, about a hundred times a
// second; it may allocate. Register before a scene is opened; what is registered stays until the program ends.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "pliant/parameters.h"
#include "pliant/result.h"

namespace pliant {

// Symmetric and positive definite, in blocks of 3 x 3, both triangles: compressed block rows. Block k of a row stands
// in column[k], columns ascend within a row, every row has its diagonal block. Lives as long as the solver.
struct BlockRows {
  std::uint32_t size = 0;                 // block rows: 3 size rows
  std::span<const std::uint32_t> first;   // size + 1: where each row begins in `column`
  std::span<const std::uint32_t> column;  // block columns
  std::span<const double> value;          // nine to a block, row by row [N/m] times [s2], or [kg]
};

class BlackBoxSolver {
 public:
  virtual ~BlackBoxSolver() = default;
  virtual void analyse(const BlockRows& matrix) { (void)matrix; }  // once: the pattern; no number counts yet
  // New numbers in the same pattern. False: not positive definite; solve() is not called until the next.
  [[nodiscard]] virtual bool factorise(const BlockRows& matrix) = 0;
  // x = A^-1 b, 3 size numbers each. x comes in as a guess.
  virtual void solve(std::span<const double> b, std::span<double> x) const = 0;
};

using SolverFactory = std::function<std::unique_ptr<BlackBoxSolver>()>;

// At most 32. An error where the name is taken or there is no factory.
Result<SolverKind> register_solver(const std::string& name, SolverFactory factory);

}  // namespace pliant
