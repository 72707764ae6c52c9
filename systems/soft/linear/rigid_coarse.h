// A coarse space for elasticity: neighbourhoods of nodes that move as rigid bodies, six numbers each. Global bending
// and drift, on which local methods (incomplete factors) converge slowly, are solved there exactly. P: from motions of
// neighbourhoods to motions of nodes, u = t + w x (x - centre) / length. (Smoothed aggregation's tentative space:
// Vanek, Mandel, Brezina 1996; as a second level: Tang et al. 2009, A-DEF2.)
#pragma once

#include <utility>
#include <vector>

#include "components/math.h"
#include "systems/soft/linear/block_cholesky.h"
#include "systems/soft/linear/half_matrix.h"

namespace pliant {

class RigidCoarse {
 public:
  void analyse(const HalfPattern& pattern);
  // position: [m] of each node of the BlockMatrix; empty: neighbourhoods only translate, which converges more slowly.
  [[nodiscard]] bool factorise(const HalfPattern& pattern, const HalfMatrix<double>& a,
                               const std::vector<dvec3>& position);
  // z += P (P^T A P)^-1 P^T r; four numbers per node.
  void correct(const float* r, float* z) const { add_correction(r, z); }
  void correct(const double* r, double* z) const { add_correction(r, z); }

 private:
  // Destination of the product of a block of A: blocks (drift, drift), (drift, turn) and (turn, drift), (turn, turn) of
  // a pair of groups are adjacent in pairs.
  struct Slot {
    std::uint32_t drift, turn;
  };
  Slot find_slot(std::uint32_t a, std::uint32_t b) const;
  void place(const HalfPattern& pattern, const std::vector<dvec3>& position);
  template <class Scalar>
  void add_correction(const Scalar* r, Scalar* z) const;

  std::vector<std::uint32_t> group_;  // of each node
  std::uint32_t groups_ = 0;
  std::vector<Slot> slot_, own_;  // of each block left of the diagonal; of each diagonal block
  std::vector<std::pair<std::uint32_t, std::uint32_t>> mirror_;  // a block of matrix_ and its transpose
  std::vector<dvec3> arm_;                                       // [1] (x - centre) / length
  BlockMatrix matrix_;                                           // two block rows per group: drift, turn
  BlockCholesky solver_;
  mutable Vector right_, motion_;
};

}  // namespace pliant
