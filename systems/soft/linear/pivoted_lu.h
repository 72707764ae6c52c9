// LU factorisation with row interchanges (Golub and Van Loan, Matrix Computations, 3.4) of small dense matrices that
// need not be symmetric. Allocates nothing. Every number is summed in the same order for every register width.
#pragma once

namespace pliant {

// a: n x n, column after column, columns `stride` numbers apart; becomes L (unit diagonal, below) and U. pivots: n.
// False: a pivot is zero or not finite.
[[nodiscard]] bool factorise_lu(double* a, int n, int stride, int* pivots);
// x = A^-1 x, n numbers.
void solve_lu(const double* a, int n, int stride, const int* pivots, double* x);

}  // namespace pliant
