// One body's response to its contacts, reduced to a few vibration modes and a flexibility without inertia.
//
// The body's step matrix is A = M + T D + T^2 K, D = alpha M + beta K. Its responses to unit impulses at the contacts,
// V = A^-1 J^T, span the motion that one soft step can produce there. In their Galerkin space G = V^T A V = J V and V^T
// M V separate inertia from elasticity, since K = (A - (1 + alpha T) M) / (T^2 + beta T). So the reduced body moves at
// 1 kHz by its dynamics, exactly as the soft step would with T, and it is passive regardless of what is left out.
//   1. pivoted Cholesky of G picks the significant rows of the contacts: G(:, picks) -> L,
//      U = V(:, picks) L(picks, :)^-T is orthonormal in A;
//   2. modes: eigenvectors of U^T M U (eigenvalues m, 1/m = 1 + alpha T + (T^2 + beta T) frequency2), scaled to M = 1;
//   3. the remainder of G beyond the modes becomes a spring: flexibility = (T^2 + beta T) (G - modes' share).
#pragma once

#include <vector>

#include "systems/soft/linear/block_matrix.h"

namespace pliant {

struct RayleighDamping {
  double alpha = 0.0;  // [1/s] of M
  double beta = 0.0;   // [s] of K
};

// Split of A into inertia and elasticity, as the body's integrator weighs them (Body::split).
struct StepSplit {
  double T = 0.0;  // [s]
  RayleighDamping damping;
  double of_mass = 1.0, of_stiffness = 1.0;                                   // [1] of implicit Euler
  double inertia() const { return of_mass + damping.alpha * T; }              // A = inertia M + elastic K
  double elastic() const { return of_stiffness * T * T + damping.beta * T; }  // [s2]
  bool massless() const { return of_mass < 0.01; }
};

// Pivoted factor: significant columns of a positive semidefinite G, in order, at most `most`. Each has a diagonal of
// the remainder above `share` of the largest one; G(:, picks) = L L(picks, :)^T.
struct PivotedFactor {
  std::vector<int> picks;
  Eigen::MatrixXd lower;  // rows of G x picks
};
PivotedFactor factor_pivoted(const Eigen::MatrixXd& gram, int most, double share);

struct Modes {
  Vector frequency2;            // [1/s2] ascending
  Eigen::MatrixXd transform;    // picks x modes: modes = V(:, picks) transform
  Eigen::MatrixXd at_contacts;  // rows of G x modes: J modes
  Vector step_share;            // 1 / (1 + alpha T + (T^2 + beta T) frequency2)
  int count() const { return static_cast<int>(frequency2.size()); }
};
// `mass`: V(:, picks)^T M V(:, picks). Keeps at most `most` modes, none above `highest` [rad/s].
Modes find_modes(const PivotedFactor& factor, const Eigen::MatrixXd& mass, const StepSplit& split, int most,
                 double highest);

// [m/N] Remainder of G without the modes, as a spring.
Eigen::MatrixXd left_flexibility(const Eigen::MatrixXd& gram, const Modes& modes, const StepSplit& split);

}  // namespace pliant
