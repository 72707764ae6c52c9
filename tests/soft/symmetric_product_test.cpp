// Half of a symmetric product, mirrored, against the whole one; products of rows.
#include "systems/soft/linear/symmetric_product.h"

#include <gtest/gtest.h>

#include "systems/soft/linear/add_three.h"

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

// Against plain products, for row lengths beside the parts of a sum; numbers beyond a row are not used.
TEST(RowKernels, AgreeWithProducts) {
  for (const int columns : {0, 1, 7, 8, 9, 48, 61}) {
    constexpr int kRows = 6;
    Rows a = Rows::Random(kRows, columns + 5), b = Rows::Random(kRows, columns + 5);
    a.rightCols(5).setConstant(NAN), b.rightCols(5).setConstant(NAN);
    const auto A = a.leftCols(columns), B = b.leftCols(columns);
    const Vector x = Vector::Random(columns);
    Vector factor = Vector::Random(kRows), y = Vector::Constant(kRows, NAN), sum = Vector::Random(columns);
    factor[1] = 0.0;
    rows_times(a.data(), a.outerStride(), kRows, columns, x.data(), y.data());
    EXPECT_LT((y - A * x).norm(), 1e-14 * (1.0 + x.norm()));
    Vector expected = sum + A.transpose() * factor;
    add_rows(a.data(), a.outerStride(), kRows, columns, factor.data(), sum.data());
    EXPECT_LT((sum - expected).norm(), 1e-14 * (1.0 + expected.norm()));

    const Rows mixed = 0.3 * A.topRows(3) - 2.0 * B.topRows(3);
    Eigen::Vector3d moved;
    expected = sum + mixed.transpose() * factor.head(3);
    add_three_rows({a.data(), b.data(), a.outerStride(), 0.3, -2.0}, columns, x.data(), factor.data(), moved.data(),
                   sum.data());
    EXPECT_LT((moved - mixed * x).norm(), 1e-14 * (1.0 + x.norm()));
    EXPECT_LT((sum - expected).norm(), 1e-14 * (1.0 + expected.norm()));
  }
}

}  // namespace
}  // namespace pliant
