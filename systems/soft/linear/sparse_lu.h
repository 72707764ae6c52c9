// LU of a larger system with many zeros: in a pile only neighbours are coupled. For the soft clock: it allocates.
#pragma once

#include <vector>

namespace pliant {

// a: n x n, column after column. x = A^-1 x, n numbers. False: there is no solution, or it would cost more than `work`
// multiplications. On return `work` is the estimated cost.
[[nodiscard]] bool solve_sparse_lu(const std::vector<double>& a, int n, double* x, double& work);

}  // namespace pliant
