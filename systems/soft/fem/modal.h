// One body's answer to its contacts, reduced to a few vibration modes and a flexibility without inertia.
//
// The body's step matrix is A = M + T D + T^2 K, D = alpha M + beta K. Its answers to unit impulses at the contacts,
// V = A^-1 J^T, span what one soft step can do there; in their Galerkin space G = V^T A V = J V and V^T M V tell
// inertia from elasticity, since K = (A - (1 + alpha T) M) / (T^2 + beta T). So the reduced body moves at 1 kHz by its
// own dynamics, exactly as the soft step would with T, and it is passive whatever is left out.
//   1. pivoted Cholesky of G picks the contacts' rows that matter: G(:, picks) -> L, U = V(:, picks) L(picks, :)^-T is
//      orthonormal in A;
//   2. modes: eigenvectors of U^T M U (eigenvalues m, 1/m = 1 + alpha T + (T^2 + beta T) frequency2), scaled to M = 1;
//   3. what G has beyond the modes kept is taken as a spring: flexibility = (T^2 + beta T) (G - modes' share).
#pragma once

#include <vector>

#include "systems/soft/linear/block_matrix.h"

namespace pliant {

struct RayleighDamping {
  double alpha = 0.0;  // [1/s] of M
  double beta = 0.0;   // [s] of K
};

// Largest first: (T^2 + beta T) of A that is not inertia.
struct StepSplit {
  double T = 0.0;  // [s]
  RayleighDamping damping;
  double inertia() const { return 1.0 + damping.alpha * T; }   // A = inertia M + elastic K
  double elastic() const { return T * T + damping.beta * T; }  // [s2]
};

// Columns of a positive semidefinite G worth keeping, in order, at most `most`, each with a diagonal of what is still
// unexplained above `share` of the largest one; G(:, picks) = L L(picks, :)^T.
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

// [m/N] of G, what the modes leave out, as a spring.
Eigen::MatrixXd left_flexibility(const Eigen::MatrixXd& gram, const Modes& modes, const StepSplit& split);

}  // namespace pliant
