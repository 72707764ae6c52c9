// Signorini and Coulomb on the Delassus operator (methods.md 2.5), independent of bodies:
//   u = W lambda + bias;  0 <= lambda_n  _|_  u_n >= 0;  |lambda_t| <= mu lambda_n, opposing u_t when sliding.
// Rows of a contact: normal, first tangent, second tangent. Used by the soft step and the touch tick: solve() allocates
// nothing, except for the memory of the first Newton steps.
//
// Static and sliding friction: a contact sticks up to mu_static; once its patch slips, friction is mu_sliding lambda_n.
// A contact that slipped in the last solve starts as slipping and sticks again only inside the smaller cone.
//
// Block Gauss-Seidel sweeps, and, if allowed, Newton steps on the pushing contacts (contact_newton.h).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "components/math.h"
#include "systems/soft/linear/block_matrix.h"

namespace pliant {

// W with mostly zero blocks: each contact's three columns, only the non-zero blocks. [1/kg]
struct ContactColumns {
  // Neighbouring rows; their first column begins at values[at], the next ones `rows` and 2 `rows` after it.
  struct Run {
    int row = 0, rows = 0;
    std::size_t at = 0;
  };
  std::vector<int> first;  // of each contact's runs, by ascending rows; one more than contacts. Empty: not in use
  std::vector<Run> runs;
  std::vector<double> values;

  void clear() { first.clear(), runs.clear(), values.clear(); }
};

using Lever = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

// Working memory of Newton steps (contact_newton.h).
struct NewtonMemory {
  std::vector<double> matrix, right, column, impulse, velocity;
  std::vector<int> pivots, contact;
  std::vector<dvec3> way, test, base;
  std::vector<double> extra;
  std::vector<std::uint8_t> dropped;
};

// All arrays may be longer than `count` requires: the leading part is valid, so that memory can be sized once.
struct ContactProblem {
  int count = 0;
  Eigen::MatrixXd W;  // [1/kg] 3 count x 3 count (leading part), symmetric, positive semidefinite
  Vector bias;        // [m/s] u without impulses; normal rows include g0/T (beta g0/T for penetrations)
  std::vector<double> mu_static, mu_sliding;  // [1]
  Vector impulse;                             // [N s] lambda; on entry the initial guess
  // Of each contact: its normal and tangents, in the axes of W, bias, impulse and velocity. Empty: the same axes.
  std::vector<dmat3> own;
  // Of each contact: bits of the axes along which it is a joint, u = 0 with any impulse, and none along the others; 0:
  // a contact. Empty: no joints.
  std::vector<std::uint8_t> held;
  // [N s] of each contact that holds its first axis: |lambda| <= most there. Empty: no bounds.
  std::vector<double> most;
  std::vector<std::uint8_t> sliding;  // in: in the last solve; out: on the cone's border
  Vector velocity;                    // [m/s] out: u
  // Contacts of one pair of bodies: the index of its first one. They break loose together, when nearly all of the load
  // is on contacts that slip at the static limit: before, those only pass the rest of the pull on. Those of tissue have
  // to slip by more than their own compliance lets them. Empty: every contact breaks loose by itself.
  std::vector<int> patch;
  std::vector<double> slipped;      // [m/s] slip at the static limit so far, by T; rigid: infinite
  std::vector<std::uint8_t> loose;  // slipped so far that it breaks loose by itself

  // Alternatives to W:
  ContactColumns sparse;
  // W = *shared + *lever *lever^T: a matrix that stays as it is between solves, and one body that moves with few
  // degrees of freedom. Without a lever: *shared alone. For sweeps without Newton steps. They outlive the solve.
  const Eigen::MatrixXd* shared = nullptr;
  const Lever* lever = nullptr;
  // Uncoupled contacts are separate problems. Only their W (or sparse) and `members` are inputs: the contacts of the
  // whole, ascending. place: part and index of each contact of the whole.
  std::vector<ContactProblem> parts;
  std::vector<int> members;
  std::vector<std::pair<int, int>> place;
  int part_count = 0;  // parts in use; 0: this is one problem

  // Internal to solve(): the diagonal blocks of W in the contacts' axes; their inverses, from when one is first needed.
  std::vector<dmat3> blocks, inverses;
  std::vector<dvec2> patch_load;  // [N s] of each patch: its normal impulses, those of slipping contacts
  NewtonMemory newton;

  // Resizes for `contacts` in one problem; values are undefined afterwards where something grew.
  void resize(int contacts);
  // The same without W.
  void resize_vectors(int contacts);
  // [1/kg] W(row, row), wherever it is stored.
  double diagonal(Eigen::Index row) const;
};

// Axes of a contact whose normal is tilted by `lean` [1] along its tangents, as columns in its original axes.
dmat3 leaning_axes(dvec2 lean);

struct SweepLimits {
  int sweeps = 50;
  double tolerance = 1e-6;      // [1] of the fastest closing without impulses: convergence of the residual
  std::uint64_t budget_ns = 0;  // 0: no limit; checked after every sweep
  int newtons = 0;              // limit of linear solves for Newton steps, per part; 0: only sweeps
};
struct SweepReport {
  int sweeps = 0, newtons = 0, alternations = 0;  // of the part with the most (contact_admm.h)
  // [m/s] natural residual: the largest over contacts of min(w lambda_n, u_n) and |w lambda_t - P(w lambda_t - u_t)|, P
  // onto the disc of radius mu w lambda_n, w the diagonal of W. Zero exactly if the contact laws are satisfied.
  double residual = 0.0;
  bool settled = true;  // the residual of every part is within its tolerance
  bool in_time = true;
  bool left_inside = false;  // of a soft step: its penetrations were not to be undone, or could not (solve_and_apply)
};
SweepReport solve(ContactProblem& problem, const SweepLimits& limits);

}  // namespace pliant
