// The inner loop of the contact solver.
#pragma once

#include <cstddef>

namespace pliant {

// u += [w0 w1 w2] d, three columns that are `stride` numbers apart, `rows` numbers each. The same bits on every
// machine.
void add_three(double* u, const double* w, std::ptrdiff_t stride, int rows, double d0, double d1, double d2);

// u += W d over `columns` of them, a multiple of three; columns with zero d are not read.
inline void add_columns(double* u, const double* w, std::ptrdiff_t stride, int rows, const double* d, int columns) {
  for (int c = 0; c < columns; c += 3)
    if (d[c] != 0.0 || d[c + 1] != 0.0 || d[c + 2] != 0.0)
      add_three(u, w + c * stride, stride, rows, d[c], d[c + 1], d[c + 2]);
}

}  // namespace pliant
