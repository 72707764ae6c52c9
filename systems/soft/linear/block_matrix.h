// Sparse symmetric positive definite matrices of 3x3 blocks: what tetrahedra assemble into. Both triangles are stored;
// columns ascend within a row; every row has its diagonal block. The pattern is fixed, the numbers change.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace pliant {

using Vector = Eigen::VectorXd;
// One row a degree of freedom, one column a right-hand side: a row of columns lies together, for SIMD across them.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

struct BlockMatrix {
  std::uint32_t size = 0;               // block rows; 3 * size rows
  std::vector<std::uint32_t> first;     // size + 1: run of each block row in `column` and `value`
  std::vector<std::uint32_t> column;    // block columns, ascending in a row
  std::vector<std::uint32_t> diagonal;  // of each row: where its diagonal block stands
  std::vector<Block> value;

  // Where block (row, col) stands, or 0xffffffff.
  std::uint32_t find(std::uint32_t row, std::uint32_t col) const;
  void multiply(const Vector& x, Vector& y) const;  // y = A x
  Eigen::MatrixXd dense() const;                    // for tests
};

// The pattern of a graph: rows i and j couple for every pair within each group (a tetrahedron's nodes); nodes at or
// above `size` are left out. Numbers are zero.
BlockMatrix make_pattern(std::uint32_t size, const std::vector<std::array<std::uint32_t, 4>>& groups);

}  // namespace pliant
