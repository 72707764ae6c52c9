// Half of a symmetric matrix of 3x3 blocks, for memory-bound products: blocks below the diagonal in rows, each row also
// used as a column. Rows are renumbered (Cuthill-McKee) for locality. Vectors have four numbers per node, the fourth 0.
#pragma once

#include <cstdint>
#include <vector>

#include "systems/soft/linear/block_matrix.h"

namespace pliant {

struct HalfPattern {
  std::vector<std::uint32_t> old_of_new;
  std::vector<std::uint32_t> first, column;     // blocks left of the diagonal, ascending in a row
  std::vector<std::uint32_t> source, diagonal;  // their indices in the BlockMatrix

  std::uint32_t size() const { return static_cast<std::uint32_t>(old_of_new.size()); }
};

HalfPattern half_pattern(const BlockMatrix& a);

template <class Scalar>
struct HalfMatrix {
  std::vector<Scalar> block, diagonal;  // 9 per block, row-major; one number more at the end, for reads four at a time

  void take(const HalfPattern& pattern, const BlockMatrix& a);
};

// y = A x.
void multiply(const HalfPattern& pattern, const HalfMatrix<double>& a, const double* x, double* y);
void multiply(const HalfPattern& pattern, const HalfMatrix<float>& a, const float* x, float* y);

}  // namespace pliant
