#include "systems/soft/linear/symmetric_product.h"

#include <algorithm>
#include <vector>

#include "runtime/assert.h"
#include "systems/soft/linear/panel_kernels.h"

namespace pliant {
namespace {

constexpr Eigen::Index kColumnsTogether = 64;  // rows of all columns that stay in the cache while tiles are summed

struct alignas(64) Tile {
  double value[kStrip * kStrip] = {};  // column after column
};

// Pads with zero columns to a multiple of eight.
Rows padded(const Rows& x, Eigen::Index columns) {
  Rows out(x.rows(), columns);
  out.leftCols(x.cols()) = x;
  out.rightCols(columns - x.cols()).setZero();
  return out;
}

}  // namespace

Eigen::MatrixXd symmetric_product(const Rows& a, const Rows& b) {
  ASSERT(a.rows() == b.rows() && a.cols() == b.cols());
  const Eigen::Index strips = (a.cols() + kStrip - 1) / kStrip, columns = strips * kStrip;
  if (columns != a.cols())
    return symmetric_product(padded(a, columns), padded(b, columns)).topLeftCorner(a.cols(), a.cols());

  std::vector<Tile> tiles(static_cast<std::size_t>(strips * (strips + 1) / 2));
  for (Eigen::Index row = 0; row < a.rows(); row += kColumnsTogether) {
    const auto rows = static_cast<int>(std::min(kColumnsTogether, a.rows() - row));
    Tile* tile = tiles.data();
    for (Eigen::Index i = 0; i < strips; ++i)
      for (Eigen::Index j = 0; j <= i; ++j, ++tile)
        add_gram(&a(row, i * kStrip), static_cast<int>(columns), &b(row, j * kStrip), static_cast<int>(columns), rows,
                 tile->value);
  }
  Eigen::MatrixXd out(columns, columns);
  const Tile* tile = tiles.data();
  for (Eigen::Index i = 0; i < strips; ++i)
    for (Eigen::Index j = 0; j <= i; ++j, ++tile)
      out.block<kStrip, kStrip>(i * kStrip, j * kStrip) =
          Eigen::Map<const Eigen::Matrix<double, kStrip, kStrip>>(tile->value);
  out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
  return out;
}

}  // namespace pliant
