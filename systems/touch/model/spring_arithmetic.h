// The spring laws of shaders/shared/law.glsl in double precision, twice: with the library's exponential, for one vertex
// or contact at a time, and with a polynomial, for loops that the compiler vectorises. Internal to the model.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "components/monotone_cubic.h"

namespace pliant {

using LawPiece = CubicPiece;

#define SHARED inline __attribute__((always_inline))
#define REAL double
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"

namespace law_exact {
using std::abs;
using std::sqrt;

struct LawConstants {
  double cubic, stiffening;              // [1/m2] [1/m], the latter not zero
  const MonotoneCubic* table = nullptr;  // nullptr: no rows
};

template <class Constants>
SHARED int law_pieces(const Constants& k) {
  return k.table ? static_cast<int>(k.table->count) : 0;
}
template <class Constants>
SHARED const LawPiece& law_piece(int i, const Constants& k) {
  return k.table->piece[static_cast<std::size_t>(i)];
}

SHARED double law_select(bool first, double a, double b) {
  return first ? a : b;
}
SHARED double law_exp(double x) {
  return std::exp(x);
}
SHARED double law_expm1(double x) {
  return std::expm1(x);
}
SHARED double law_second(double x, double em1) {
  const double x2 = x * x, x4 = x2 * x2;
  const double series = ((0.5 + x * (1.0 / 6)) + x2 * (1.0 / 24 + x * (1.0 / 120))) +
                        x4 * ((1.0 / 720 + x * (1.0 / 5040)) + x2 * (1.0 / 40320));
  const bool small = std::abs(x) < 0.03;
  return law_select(small, series, (em1 - x) / law_select(small, 1.0, x2));
}
#include "shaders/shared/law.glsl"
}  // namespace law_exact

namespace law_lanes {
using law_exact::law_piece;
using law_exact::law_pieces;
using law_exact::law_second;
using law_exact::law_select;
using std::abs;
using std::sqrt;

// A divisor whose inverse is computed once: a division costs as much as the rest of a law.
struct Divisor {
  double value, inverse;
  SHARED operator double() const { return value; }
  friend SHARED double operator/(double x, const Divisor& by) { return x * by.inverse; }
};
struct LawConstants {
  double cubic;
  Divisor stiffening;
  const MonotoneCubic* table = nullptr;
};

// e^x - 1 to a few ulp. x is clamped to the range of double; beyond it the bracket decides.
SHARED double law_expm1(double x) {
  x = law_select(x < 700.0, x, 700.0);
  x = law_select(x > -700.0, x, -700.0);
  constexpr double kRound = 6755399441055744.0;  // 1.5 * 2^52: its last bit has value 1
  const double shifted = x * 1.4426950408889634 + kRound, n = shifted - kRound;
  const double r = (x - n * 6.93147180369123816490e-01) - n * 1.90821492927058770002e-10;
  // The series in pairs (Estrin's scheme): Horner's would be a chain of twelve dependent operations.
  const double r2 = r * r, r4 = r2 * r2;
  const double p0 = 0.5 + r * (1.0 / 6), p1 = 1.0 / 24 + r * (1.0 / 120), p2 = 1.0 / 720 + r * (1.0 / 5040),
               p3 = 1.0 / 40320 + r * (1.0 / 362880), p4 = 1.0 / 3628800 + r * (1.0 / 39916800);
  const double tail = (p2 + r2 * p3) + r4 * (p4 + r2 * (1.0 / 479001600));
  const double p = r + r2 * ((p0 + r2 * p1) + r4 * tail);
  const double power = std::bit_cast<double>((std::bit_cast<std::uint64_t>(shifted) + 1023) << 52);
  return power * p + (power - 1.0);
}
SHARED double law_exp(double x) {
  return 1.0 + law_expm1(x);
}
#include "shaders/shared/law.glsl"
}  // namespace law_lanes

#pragma GCC diagnostic pop
#undef REAL
#undef SHARED

}  // namespace pliant
