// Dense arithmetic on the panels of a sparse Cholesky factor (block_cholesky.h). A panel has `strips` strips of 8 rows,
// each stored column after column: element (r, c) stands at panel[(r / 8) * 8 * columns + c * 8 + r % 8]. Its first
// `columns` rows are the lower triangle of a diagonal block. What is solved for stands in packs of 8 right-hand sides.
// Every number is summed in the same order whatever the width of the machine's registers: same bits everywhere.
#pragma once

namespace pliant {

constexpr int kStrip = 8;

struct FactorPanel {
  const double* data = nullptr;  // 64-byte aligned, strips * columns * 8
  int columns = 0, strips = 0;
};

// Doubles in a triangle of strips: strip i holds columns 0 .. 8 i + 7.
constexpr long triangle_size(int strips) {
  return 32L * strips * (strips + 1);
}

// data (the panel's) = its Cholesky factor, rows under the diagonal block included. reciprocal: 1 / diagonal, `columns`
// of them. False: a pivot is not positive and finite.
[[nodiscard]] bool factorise_panel(double* data, FactorPanel panel, double* reciprocal);

// triangle -= L L^T over the strips from columns / 8 on, L the panel. Rows and columns that belong to the diagonal
// block get junk, and so does what stands above the diagonal.
void update_triangle(FactorPanel panel, double* triangle);

// One right-hand side. forward: x (rows of the panel) holds the diagonal block's part of the right-hand side, then its
// solution, then what is to be added to the rows below. backward: x holds solutions below, right-hand side above;
// sums: scratch of 8 * columns.
void forward(FactorPanel panel, const double* reciprocal, double* x);
void backward(FactorPanel panel, const double* reciprocal, double* x, double* sums);

// The same for packs of 8 right-hand sides: x[8 * row + which]. Backwards, columns are taken a few at a time, and
// those beyond the last are read too, for nothing: with strips below a diagonal block whose columns are no multiple of
// 8, 64 doubles behind the panel must be readable. In a factor the next panel stands there, as the last has no strips
// below.
void forward_many(FactorPanel panel, const double* reciprocal, double* x);
void backward_many(FactorPanel panel, const double* reciprocal, double* x);

// tile[8 j + i] += x_i . y_j over `rows` rows of eight columns each, whose rows stand `x_step` and `y_step` numbers
// apart. The tile is 64-byte aligned.
void add_gram(const double* x, int x_step, const double* y, int y_step, int rows, double* tile);

// Width of the registers that these use on this machine: 32 with AVX2, else 16. [bytes]
int panel_register_bytes();

// The same for any machine: what the others must agree with.
namespace plain {
bool factorise_panel(double* data, FactorPanel panel, double* reciprocal);
void update_triangle(FactorPanel panel, double* triangle);
void forward(FactorPanel panel, const double* reciprocal, double* x);
void backward(FactorPanel panel, const double* reciprocal, double* x, double* sums);
void forward_many(FactorPanel panel, const double* reciprocal, double* x);
void backward_many(FactorPanel panel, const double* reciprocal, double* x);
void add_gram(const double* x, int x_step, const double* y, int y_step, int rows, double* tile);
int panel_register_bytes();
}  // namespace plain

}  // namespace pliant
