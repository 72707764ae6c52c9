// A^T B if it is symmetric, as A^T M A is: half of the product, by the kernels of panel_kernels.h. Every number is
// summed in the same order for every register width.
#pragma once

#include "systems/soft/linear/block_matrix.h"

namespace pliant {

// A^T B; `a` and `b` have the same shape. The lower triangle is computed, the upper one mirrored.
Eigen::MatrixXd symmetric_product(const Rows& a, const Rows& b);

}  // namespace pliant
