// A^T B where it is symmetric, as A^T M A is: half of the product, by the kernels of panel_kernels.h. Every number is
// summed in the same order whatever the width of the machine's registers.
#pragma once

#include "systems/soft/linear/block_matrix.h"

namespace pliant {

// A^T B, as many rows as `a` has columns; of the same shape both. The lower triangle is computed, the upper its mirror
// image.
Eigen::MatrixXd symmetric_product(const Rows& a, const Rows& b);

}  // namespace pliant
