// Signorini and Coulomb by block Gauss-Seidel on the Delassus operator (methods.md 2.5), without a word of bodies:
//   u = W lambda + bias;  0 <= lambda_n  _|_  u_n >= 0;  |lambda_t| <= mu lambda_n, opposing u_t when sliding.
// Rows of a contact: normal, first tangent, second tangent. Serves the soft step and the touch tick alike: solve()
// allocates nothing.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "systems/tool/block_matrix.h"

namespace pliant {

struct ContactProblem {
  int count = 0;
  Eigen::MatrixXd W;  // [1/kg] 3 count x 3 count (leading part), symmetric, positive semidefinite
  Vector bias;        // [m/s] u without impulses; normal rows carry g0/T (beta g0/T where penetrating)
  std::vector<double> mu_static, mu_sliding;  // [1]
  Vector impulse;                             // [N s] lambda; comes in as a guess
  std::vector<std::uint8_t> sliding;          // out: on the cone's border
};

struct SweepLimits {
  int sweeps = 50;
  double tolerance = 1e-6;      // [1] of the largest |bias|: stop when the natural residual is below
  std::uint64_t budget_ns = 0;  // 0: no limit; checked after every sweep
};
struct SweepReport {
  int sweeps = 0;
  double residual = 0.0;  // [m/s] natural residual, largest over contacts
  bool in_time = true;
};
SweepReport solve(ContactProblem& problem, const SweepLimits& limits);

}  // namespace pliant
