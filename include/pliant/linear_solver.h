// Custom linear solvers for soft bodies (P2: black boxes): derive, register under a name, and set the result in
// SoftBodyParameters::solver, or the name in a level file (`solver`).
//
// One instance per body. It is created when a session opens and called by the soft clock, about a hundred times a
// second; it may allocate. Register before opening a scene; registrations last until the program ends.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "pliant/parameters.h"
#include "pliant/result.h"

namespace pliant {

// Symmetric positive definite matrix in 3 x 3 blocks, both triangles, compressed block rows. Block k of a row is in
// column[k]; columns ascend within a row; every row has its diagonal block. Valid for the lifetime of the solver.
struct BlockRows {
  std::uint32_t size = 0;                 // block rows: 3 size rows
  std::span<const std::uint32_t> first;   // size + 1: start of each row in `column`
  std::span<const std::uint32_t> column;  // block columns
  std::span<const double> value;          // nine per block, row by row [N/m] times [s2], or [kg]
};

class BlackBoxSolver {
 public:
  virtual ~BlackBoxSolver() = default;
  virtual void analyse(const BlockRows& matrix) {
    (void)matrix;
  }  // called once with the pattern; values are not valid
     // yet
  // New values in the same pattern. False: not positive definite; solve() is not called until the next factorisation.
  [[nodiscard]] virtual bool factorise(const BlockRows& matrix) = 0;
  // x = A^-1 b, 3 size numbers each. x contains an initial guess.
  virtual void solve(std::span<const double> b, std::span<double> x) const = 0;
};

using SolverFactory = std::function<std::unique_ptr<BlackBoxSolver>()>;

// At most 32. Error: the name is in use, or there is no factory.
Result<SolverKind> register_solver(const std::string& name, SolverFactory factory);

}  // namespace pliant
