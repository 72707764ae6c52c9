// Dense arithmetic on the panels of a sparse Cholesky factor (block_cholesky.h). A panel has `strips` strips of 8 rows,
// each stored column after column: element (r, c) is at panel[(r / 8) * 8 * columns + c * 8 + r % 8]. Its first
// `columns` rows are the lower triangle of a diagonal block. Right-hand sides are in packs of 8. Every number is summed
// in the same order for every register width: same bits everywhere.
#pragma once

namespace pliant {

constexpr int kStrip = 8;

struct FactorPanel {
  const double* data = nullptr;  // 64-byte aligned, strips * columns * 8
  int columns = 0, strips = 0;
};

// Doubles in a triangle of strips: strip i has columns 0 .. 8 i + 7.
constexpr long triangle_size(int strips) {
  return 32L * strips * (strips + 1);
}

// A rectangle of a panel: whole strips from `from` up to `to`, columns from `first` (a multiple of 8) up to `last`.
struct PanelPart {
  int first = 0, last = 0, from = 0, to = 0;
};

// data (the panel's) becomes its Cholesky factor, part by part: columns before part.first are done in all strips that
// are read. A part with the diagonal block of its columns, then strips below it, in any order or at once. reciprocal: 1
// / diagonal, `columns` of them. False: a pivot is not positive and finite.
[[nodiscard]] bool factorise_part(double* data, FactorPanel panel, double* reciprocal, PanelPart part);

// triangle -= L L^T over the strips from columns / 8 on, L the panel: of its strips from `from` up to `to`, counted in
// the panel. Rows and columns that belong to the diagonal block, and entries above the diagonal, are undefined.
void update_triangle(FactorPanel panel, double* triangle, int from, int to);

// One right-hand side. forward: x (rows of the panel) is the diagonal block's part of the right-hand side on entry,
// then its solution, followed by the update of the rows below. backward: x has solutions below, right-hand side above;
// sums: scratch of 8 * columns.
void forward(FactorPanel panel, const double* reciprocal, double* x);
void backward(FactorPanel panel, const double* reciprocal, double* x, double* sums);

// The same for packs of 8 right-hand sides: x[8 * row + which]. backward_many processes a few columns at a time, and
// also reads beyond the last one without using the values. With strips below a diagonal block whose columns are not a
// multiple of 8, 64 doubles after the panel must therefore be readable. In a factor the next panel follows; the last
// one has no strips below.
void forward_many(FactorPanel panel, const double* reciprocal, double* x);
void backward_many(FactorPanel panel, const double* reciprocal, double* x);

// tile[8 j + i] += x_i . y_j over `rows` rows of eight columns each, with row strides `x_step` and `y_step`. The tile
// is 64-byte aligned.
void add_gram(const double* x, int x_step, const double* y, int y_step, int rows, double* tile);

// Width of the registers used on this machine: 32 with AVX2, else 16. [bytes]
int panel_register_bytes();

// Portable versions: the reference for the others.
namespace plain {
bool factorise_part(double* data, FactorPanel panel, double* reciprocal, PanelPart part);
void update_triangle(FactorPanel panel, double* triangle, int from, int to);
void forward(FactorPanel panel, const double* reciprocal, double* x);
void backward(FactorPanel panel, const double* reciprocal, double* x, double* sums);
void forward_many(FactorPanel panel, const double* reciprocal, double* x);
void backward_many(FactorPanel panel, const double* reciprocal, double* x);
void add_gram(const double* x, int x_step, const double* y, int y_step, int rows, double* tile);
int panel_register_bytes();
}  // namespace plain

}  // namespace pliant
