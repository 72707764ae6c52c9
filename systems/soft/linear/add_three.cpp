#include "systems/soft/linear/add_three.h"

#include "runtime/kernel.h"

namespace pliant {
namespace {

PLIANT_KERNEL void add(double* __restrict u, const double* __restrict w, std::ptrdiff_t stride, int rows, double d0,
                       double d1, double d2) {
  const double* __restrict w0 = w;
  const double* __restrict w1 = w + stride;
  const double* __restrict w2 = w + 2 * stride;
  for (int i = 0; i < rows; ++i) u[i] += (w0[i] * d0 + w1[i] * d1) + w2[i] * d2;
}

constexpr int kRowParts = 8;

inline double sum_of(const double (&parts)[kRowParts]) {
  return ((parts[0] + parts[4]) + (parts[2] + parts[6])) + ((parts[1] + parts[5]) + (parts[3] + parts[7]));
}

PLIANT_KERNEL void multiply_rows(const double* __restrict a, std::ptrdiff_t stride, int rows, int columns,
                                 const double* __restrict x, double* __restrict y) {
  for (int r = 0; r < rows; ++r, a += stride) {
    double parts[kRowParts] = {};
    int c = 0;
    for (; c + kRowParts <= columns; c += kRowParts)
      for (int l = 0; l < kRowParts; ++l) parts[l] += a[c + l] * x[c + l];
    for (; c < columns; ++c) parts[c % kRowParts] += a[c] * x[c];
    y[r] = sum_of(parts);
  }
}

PLIANT_KERNEL void add_scaled_rows(const double* __restrict a, std::ptrdiff_t stride, int rows, int columns,
                                   const double* __restrict x, double* __restrict y) {
  for (int r = 0; r < rows; ++r, a += stride) {
    const double s = x[r];
    if (s == 0.0) continue;
    for (int c = 0; c < columns; ++c) y[c] += s * a[c];
  }
}

PLIANT_KERNEL void add_mixed_rows(const TwoRows& of, int columns, const double* __restrict x,
                                  const double* __restrict factor, double* __restrict moved, double* __restrict y) {
  const double s0 = of.s0, s1 = of.s1;
  for (int r = 0; r < 3; ++r) {
    const double* __restrict a0 = of.a0 + r * of.stride;
    const double* __restrict a1 = of.a1 + r * of.stride;
    const double f = factor[r];
    double parts[kRowParts] = {};
    int c = 0;
    for (; c + kRowParts <= columns; c += kRowParts)
      for (int l = 0; l < kRowParts; ++l) {
        const double mixed = s0 * a0[c + l] + s1 * a1[c + l];
        parts[l] += mixed * x[c + l];
        y[c + l] += f * mixed;
      }
    for (; c < columns; ++c) {
      const double mixed = s0 * a0[c] + s1 * a1[c];
      parts[c % kRowParts] += mixed * x[c];
      y[c] += f * mixed;
    }
    moved[r] = sum_of(parts);
  }
}

}  // namespace

void rows_times(const double* a, std::ptrdiff_t stride, int rows, int columns, const double* x, double* y) {
  multiply_rows(a, stride, rows, columns, x, y);
}

void add_rows(const double* a, std::ptrdiff_t stride, int rows, int columns, const double* x, double* y) {
  add_scaled_rows(a, stride, rows, columns, x, y);
}

void add_three_rows(const TwoRows& of, int columns, const double* x, const double* factor, double* moved, double* y) {
  add_mixed_rows(of, columns, x, factor, moved, y);
}

void add_three(double* u, const double* w, std::ptrdiff_t stride, int rows, double d0, double d1, double d2) {
  add(u, w, stride, rows, d0, d1, d2);
}

}  // namespace pliant
