#include "systems/soft/linear/symmetric_product.h"

#include <algorithm>
#include <vector>

#include "runtime/assert.h"
#include "runtime/tasks.h"
#include "systems/soft/linear/panel_kernels.h"

namespace pliant {
namespace {

constexpr double kSharedProduct = 4e6;         // [1] multiplications: fewer are faster on one thread
constexpr Eigen::Index kShares = 4;            // tasks: every so many rows of tiles, as later rows are longer
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
  const auto add_tiles = [&](Eigen::Index first, Eigen::Index step) {
    for (Eigen::Index row = 0; row < a.rows(); row += kColumnsTogether) {
      const auto rows = static_cast<int>(std::min(kColumnsTogether, a.rows() - row));
      for (Eigen::Index i = first; i < strips; i += step)
        for (Eigen::Index j = 0; j <= i; ++j)
          add_gram(&a(row, i * kStrip), static_cast<int>(columns), &b(row, j * kStrip), static_cast<int>(columns), rows,
                   tiles[static_cast<std::size_t>(i * (i + 1) / 2 + j)].value);
    }
  };
  if (static_cast<double>(a.rows() * columns) * static_cast<double>(columns) < kSharedProduct)
    add_tiles(0, 1);
  else
    run_tasks(kShares, [&](std::size_t share, unsigned) { add_tiles(static_cast<Eigen::Index>(share), kShares); });
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
