// Signorini and Coulomb by block Gauss-Seidel on the Delassus operator (methods.md 2.5), without a word of bodies:
//   u = W lambda + bias;  0 <= lambda_n  _|_  u_n >= 0;  |lambda_t| <= mu lambda_n, opposing u_t when sliding.
// Rows of a contact: normal, first tangent, second tangent. Serves the soft step and the touch tick alike: solve()
// allocates nothing.
//
// Static and sliding friction: a contact holds up to mu_static; once it slips, friction is mu_sliding lambda_n. A
// contact that slipped in the last solve starts as slipping and holds again only inside the smaller cone.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "components/math.h"
#include "systems/tool/block_matrix.h"

namespace pliant {

// All arrays may be longer than `count` asks for: the leading part counts, so that memory can be sized once.
struct ContactProblem {
  int count = 0;
  Eigen::MatrixXd W;  // [1/kg] 3 count x 3 count (leading part), symmetric, positive semidefinite
  Vector bias;        // [m/s] u without impulses; normal rows carry g0/T (beta g0/T where penetrating)
  std::vector<double> mu_static, mu_sliding;  // [1]
  Vector impulse;                             // [N s] lambda; comes in as a guess
  // Of each contact: its normal and tangents, in the axes that W, bias, impulse and velocity are written in. Empty: the
  // same axes.
  std::vector<dmat3> own;
  std::vector<std::uint8_t> sliding;  // in: in the last solve; out: on the cone's border
  Vector velocity;                    // [m/s] out: u

  // Room for `contacts`; numbers are undefined afterwards where something grew.
  void resize(int contacts);
};

// Axes of a contact whose normal leans by `lean` [1] along its tangents, as columns in the axes that it was laid in.
dmat3 leaning_axes(dvec2 lean);

struct SweepLimits {
  int sweeps = 50;
  double tolerance = 1e-6;      // [1] of the largest |bias|: stop when the natural residual is below
  std::uint64_t budget_ns = 0;  // 0: no limit; checked after every sweep
};
struct SweepReport {
  int sweeps = 0;
  // [m/s] natural residual: the largest over contacts of min(w lambda_n, u_n) and |w lambda_t - P(w lambda_t - u_t)|, P
  // onto the disc of radius mu w lambda_n, w the diagonal of W. Zero exactly where the contact laws hold.
  double residual = 0.0;
  bool in_time = true;
};
SweepReport solve(ContactProblem& problem, const SweepLimits& limits);

}  // namespace pliant
