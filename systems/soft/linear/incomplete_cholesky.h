// Incomplete Cholesky factor without fill, in 3x3 blocks: A ~ (D + W) D^-1 (D + W)^T with W on the pattern of A below
// its diagonal (IC(0): Meijerink and van der Vorst 1977). Computed in double, stored and applied in single precision:
// it is only a preconditioner, and it is memory-bound.
#pragma once

#include <vector>

#include "systems/soft/linear/half_matrix.h"

namespace pliant {

class IncompleteCholesky {
 public:
  // If a pivot breaks down although A is positive definite, diagonals are increased and it starts again. False: a
  // diagonal block of A is not positive definite, or not finite.
  [[nodiscard]] bool factorise(const HalfPattern& pattern, const HalfMatrix<double>& a);
  void apply(const HalfPattern& pattern, const float* r, float* z) const;  // four numbers per node

 private:
  bool try_factorise(const HalfPattern& pattern, const HalfMatrix<double>& a, double lift);

  std::vector<Block> w_, row_, inverse_d_;
  std::vector<float> block_, inverse_;  // W and D^-1, 9 per block and one more
  mutable std::vector<float> rest_;
};

}  // namespace pliant
