// Half of a symmetric product, mirrored, against the whole one.
#include "systems/soft/linear/symmetric_product.h"

#include <gtest/gtest.h>

namespace pliant {
namespace {

TEST(SymmetricProduct, IsTheWholeProductAndItsOwnMirrorImage) {
  for (const int rows : {0, 1, 64, 131})
    for (const int columns : {0, 1, 7, 8, 21, 48}) {
      const Rows a = Rows::Random(rows, columns);
      const Vector weights = Vector::Random(rows);
      const Rows b = weights.asDiagonal() * a;
      const Eigen::MatrixXd out = symmetric_product(a, b), whole = a.transpose() * b;
      ASSERT_EQ(out.rows(), columns);
      EXPECT_EQ(out, out.transpose());
      EXPECT_LE((out - whole).norm(), 1e-14 * rows * columns) << rows << " rows, " << columns << " columns";
    }
}

}  // namespace
}  // namespace pliant
