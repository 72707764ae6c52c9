#include "systems/soft/linear/block_matrix.h"

#include <algorithm>

namespace pliant {

std::uint32_t BlockMatrix::find(std::uint32_t row, std::uint32_t col) const {
  const auto begin = column.begin() + first[row], end = column.begin() + first[row + 1];
  const auto found = std::lower_bound(begin, end, col);
  return found != end && *found == col ? static_cast<std::uint32_t>(found - column.begin()) : 0xffffffffu;
}

void BlockMatrix::multiply(const Vector& x, Vector& y) const {
  y.resize(3 * size);
  for (std::uint32_t row = 0; row < size; ++row) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::uint32_t k = first[row]; k < first[row + 1]; ++k) sum += value[k] * x.segment<3>(3 * column[k]);
    y.segment<3>(3 * row) = sum;
  }
}

Eigen::MatrixXd BlockMatrix::dense() const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3 * size, 3 * size);
  for (std::uint32_t row = 0; row < size; ++row)
    for (std::uint32_t k = first[row]; k < first[row + 1]; ++k) out.block<3, 3>(3 * row, 3 * column[k]) = value[k];
  return out;
}

BlockMatrix make_pattern(std::uint32_t size, const std::vector<std::array<std::uint32_t, 4>>& groups) {
  // Neighbours with repetitions, bucketed by row; then sorted and made unique row by row.
  std::vector<std::uint32_t> begin(size + 1, 1);  // every row has its diagonal
  begin[0] = 0;
  for (const auto& group : groups)
    for (const std::uint32_t row : group)
      if (row < size) begin[row + 1] += 4;
  for (std::uint32_t row = 0; row < size; ++row) begin[row + 1] += begin[row];
  std::vector<std::uint32_t> neighbour(begin[size]), end(begin.begin(), begin.end() - 1);
  for (std::uint32_t row = 0; row < size; ++row) neighbour[end[row]++] = row;
  for (const auto& group : groups)
    for (const std::uint32_t row : group)
      if (row < size)
        for (const std::uint32_t col : group)
          if (col < size) neighbour[end[row]++] = col;

  BlockMatrix a;
  a.size = size;
  a.first.reserve(size + 1);
  a.diagonal.reserve(size);
  a.first.push_back(0);
  for (std::uint32_t row = 0; row < size; ++row) {
    const auto from = neighbour.begin() + begin[row];
    std::sort(from, neighbour.begin() + end[row]);
    a.column.insert(a.column.end(), from, std::unique(from, neighbour.begin() + end[row]));
    a.first.push_back(static_cast<std::uint32_t>(a.column.size()));
    a.diagonal.push_back(a.find(row, row));
  }
  a.value.assign(a.column.size(), Block::Zero());
  return a;
}

}  // namespace pliant
