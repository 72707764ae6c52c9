// Signorini and Coulomb on the Delassus operator (methods.md 2.5), without a word of bodies:
//   u = W lambda + bias;  0 <= lambda_n  _|_  u_n >= 0;  |lambda_t| <= mu lambda_n, opposing u_t when sliding.
// Rows of a contact: normal, first tangent, second tangent. Serves the soft step and the touch tick alike: solve()
// allocates nothing, but for the memory of Newton steps the first times that they are asked for.
//
// Static and sliding friction: a contact holds up to mu_static; once it slips, friction is mu_sliding lambda_n. A
// contact that slipped in the last solve starts as slipping and holds again only inside the smaller cone.
//
// Block Gauss-Seidel sweeps, and, where they are allowed, Newton steps on the contacts that push (contact_newton.h).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "components/math.h"
#include "systems/soft/linear/block_matrix.h"

namespace pliant {

// W where most of its blocks are zero: each contact's three columns, only where they are not. [1/kg]
struct ContactColumns {
  // Neighbouring rows; their first column stands at values[at], the next ones `rows` and 2 `rows` behind it.
  struct Run {
    int row = 0, rows = 0;
    std::size_t at = 0;
  };
  std::vector<int> first;  // of each contact's runs, by ascending rows; one more than contacts. Empty: not in use
  std::vector<Run> runs;
  std::vector<double> values;

  void clear() { first.clear(), runs.clear(), values.clear(); }
};

// What Newton steps keep between them (contact_newton.h).
struct NewtonMemory {
  std::vector<double> matrix, right, column, impulse, velocity;
  std::vector<int> pivots, contact;
  std::vector<dvec3> way, test, base;
  std::vector<double> extra;
  std::vector<std::uint8_t> dropped;
};

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

  // Instead of W, one of these:
  ContactColumns sparse;
  // Contacts that do not move each other are problems apart, of which only W (or sparse) and `members` come in: the
  // contacts of the whole, ascending. place: of each contact of the whole, its part and its number there.
  std::vector<ContactProblem> parts;
  std::vector<int> members;
  std::vector<std::pair<int, int>> place;
  int part_count = 0;  // parts in use; 0: this is one problem

  std::vector<dmat3> blocks;  // solve()'s own: the diagonal blocks of W in the contacts' own axes
  NewtonMemory newton;

  // Room for `contacts` in one problem; numbers are undefined afterwards where something grew.
  void resize(int contacts);
  // The same without W.
  void resize_vectors(int contacts);
  // [1/kg] W(row, row), wherever it is kept.
  double diagonal(Eigen::Index row) const;
};

// Axes of a contact whose normal leans by `lean` [1] along its tangents, as columns in the axes that it was laid in.
dmat3 leaning_axes(dvec2 lean);

struct SweepLimits {
  int sweeps = 50;
  double tolerance = 1e-6;      // [1] of the fastest closing without impulses: stop when the residual is below
  std::uint64_t budget_ns = 0;  // 0: no limit; checked after every sweep
  int newtons = 0;              // systems that may be solved for Newton steps, of each part; 0: sweeps alone
};
struct SweepReport {
  int sweeps = 0, newtons = 0, alternations = 0;  // of the part that took the most (contact_admm.h)
  // [m/s] natural residual: the largest over contacts of min(w lambda_n, u_n) and |w lambda_t - P(w lambda_t - u_t)|, P
  // onto the disc of radius mu w lambda_n, w the diagonal of W. Zero exactly where the contact laws hold.
  double residual = 0.0;
  bool settled = true;  // the residual of every part is within its tolerance
  bool in_time = true;
};
SweepReport solve(ContactProblem& problem, const SweepLimits& limits);

}  // namespace pliant
