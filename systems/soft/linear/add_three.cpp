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

}  // namespace

void add_three(double* u, const double* w, std::ptrdiff_t stride, int rows, double d0, double d1, double d2) {
  add(u, w, stride, rows, d0, d1, d2);
}

}  // namespace pliant
