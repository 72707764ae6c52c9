// Inner loops of the contact solver and of the touch tick. The same bits on every machine: sums over a row have eight
// parts, whatever the width of registers.
#pragma once

#include <cstddef>

namespace pliant {

// u += [w0 w1 w2] d, three columns that are `stride` numbers apart, `rows` numbers each.
void add_three(double* u, const double* w, std::ptrdiff_t stride, int rows, double d0, double d1, double d2);

// u += W d over `columns` of them, a multiple of three; columns with zero d are not read.
inline void add_columns(double* u, const double* w, std::ptrdiff_t stride, int rows, const double* d, int columns) {
  for (int c = 0; c < columns; c += 3)
    if (d[c] != 0.0 || d[c + 1] != 0.0 || d[c + 2] != 0.0)
      add_three(u, w + c * stride, stride, rows, d[c], d[c + 1], d[c + 2]);
}

// Rows of a matrix, `stride` apart, `columns` numbers each. y = A x; y += A^T x, rows with zero x are not read.
void rows_times(const double* a, std::ptrdiff_t stride, int rows, int columns, const double* x, double* y);
void add_rows(const double* a, std::ptrdiff_t stride, int rows, int columns, const double* x, double* y);

// Three rows of s0 A0 + s1 A1: moved = their products with x, y += their sum by `factor`.
struct TwoRows {
  const double *a0, *a1;
  std::ptrdiff_t stride;
  double s0, s1;
};
void add_three_rows(const TwoRows& of, int columns, const double* x, const double* factor, double* moved, double* y);

}  // namespace pliant
