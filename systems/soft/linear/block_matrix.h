// Sparse symmetric positive definite matrices of 3x3 blocks, as assembled from tetrahedra. Both triangles are stored;
// columns ascend within a row; every row has its diagonal block. The pattern is fixed, the values change.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace pliant {

using Vector = Eigen::VectorXd;
// One row per degree of freedom, one column per right-hand side: rows are contiguous, for SIMD across columns.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

struct BlockMatrix {
  std::uint32_t size = 0;               // block rows; 3 * size rows
  std::vector<std::uint32_t> first;     // size + 1: run of each block row in `column` and `value`
  std::vector<std::uint32_t> column;    // block columns, ascending in a row
  std::vector<std::uint32_t> diagonal;  // of each row: index of its diagonal block
  std::vector<Block> value;

  // Index of block (row, col), or 0xffffffff.
  std::uint32_t find(std::uint32_t row, std::uint32_t col) const;
  void multiply(const Vector& x, Vector& y) const;  // y = A x
  Eigen::MatrixXd dense() const;                    // for tests
};

// The pattern of a graph: rows i and j are coupled for every pair within each group (a tetrahedron's nodes). Nodes at
// or above `size` are left out. Values are zero.
BlockMatrix make_pattern(std::uint32_t size, const std::vector<std::array<std::uint32_t, 4>>& groups);

}  // namespace pliant
