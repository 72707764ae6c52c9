#include "systems/soft/linear/pivoted_lu.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "runtime/kernel.h"

namespace pliant {
namespace {

constexpr int kPanel = 4;  // columns that are eliminated together: the rest of the matrix is read once for all of them

// x -= [l0 l1 l2 l3] f, columns of l `stride` apart.
PLIANT_KERNEL void subtract_columns(double* __restrict x, const double* __restrict l, std::ptrdiff_t stride, int rows,
                                    double f0, double f1, double f2, double f3) {
  const double* __restrict l0 = l;
  const double* __restrict l1 = l + stride;
  const double* __restrict l2 = l + 2 * stride;
  const double* __restrict l3 = l + 3 * stride;
  for (int i = 0; i < rows; ++i) x[i] -= ((l0[i] * f0 + l1[i] * f1) + l2[i] * f2) + l3[i] * f3;
}
PLIANT_KERNEL void subtract_column(double* __restrict x, const double* __restrict l, int rows, double f) {
  for (int i = 0; i < rows; ++i) x[i] -= l[i] * f;
}

// The matrix and the layout of its columns.
struct Columns {
  double* a;
  std::ptrdiff_t stride;
  int n;
  double* operator[](int column) const { return a + column * stride; }
};

// Columns [first, end), from row `first` on. Interchanges affect only these columns.
bool factorise_panel_columns(const Columns& m, int first, int end, int* pivots) {
  for (int j = first; j < end; ++j) {
    double* const column = m[j];
    int best = j;
    for (int i = j + 1; i < m.n; ++i)
      if (std::abs(column[i]) > std::abs(column[best])) best = i;
    pivots[j] = best;
    const double pivot = column[best];
    if (!(std::abs(pivot) > 0.0) || !std::isfinite(pivot)) return false;
    for (int c = first; c < end && best != j; ++c) std::swap(m[c][j], m[c][best]);
    for (int i = j + 1; i < m.n; ++i) column[i] /= pivot;
    for (int c = j + 1; c < end; ++c) subtract_column(m[c] + j + 1, column + j + 1, m.n - j - 1, m[c][j]);
  }
  return true;
}

// One column to the right of a factorised panel [first, end): interchanges, its part of U, and the update of the rest.
void eliminate(const Columns& m, int first, int end, const int* pivots, double* column) {
  for (int j = first; j < end; ++j) std::swap(column[j], column[pivots[j]]);
  for (int j = first; j < end; ++j) subtract_column(column + j + 1, m[j] + j + 1, end - j - 1, column[j]);
  if (end - first == kPanel)
    subtract_columns(column + end, m[first] + end, m.stride, m.n - end, column[first], column[first + 1],
                     column[first + 2], column[first + 3]);
  else
    for (int j = first; j < end; ++j) subtract_column(column + end, m[j] + end, m.n - end, column[j]);
}

}  // namespace

bool factorise_lu(double* a, int n, int stride, int* pivots) {
  const Columns m{a, stride, n};
  for (int first = 0; first < n; first += kPanel) {
    const int end = std::min(first + kPanel, n);
    if (!factorise_panel_columns(m, first, end, pivots)) return false;
    for (int c = end; c < n; ++c) eliminate(m, first, end, pivots, m[c]);
    for (int c = 0; c < first; ++c)
      for (int j = first; j < end; ++j) std::swap(m[c][j], m[c][pivots[j]]);
  }
  return true;
}

void solve_lu(const double* a, int n, int stride, const int* pivots, double* x) {
  for (int j = 0; j < n; ++j) std::swap(x[j], x[pivots[j]]);
  for (int j = 0; j < n; ++j) {
    const double* const column = a + static_cast<std::ptrdiff_t>(j) * stride;
    subtract_column(x + j + 1, column + j + 1, n - j - 1, x[j]);
  }
  for (int j = n - 1; j >= 0; --j) {
    const double* const column = a + static_cast<std::ptrdiff_t>(j) * stride;
    x[j] /= column[j];
    subtract_column(x, column, j, x[j]);
  }
}

}  // namespace pliant
