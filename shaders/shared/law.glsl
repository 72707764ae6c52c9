// The spring laws: arithmetic that is valid GLSL and C++, in single precision on the GPU and in double on the CPU
// (systems/touch/model/spring_arithmetic.h, shaders/law.glsl). methods.md 1.2. To add a law, write its five functions here and
// its line in components/built_in.h; tests/touch/law_table_test.cpp checks them against each other.
//
// Per unit of small-depth stiffness, h the height [m] (below zero: pushed in), k the authored constants:
//   NAME_force(h)            [m]  rises with h, 0 at 0
//   NAME_slope(h)            [1]  its derivative, 1 at 0
//   NAME_potential(h)        [m2] its integral from 0
//   NAME_keep(h0)                 number that every NAME_between from the same h0 needs, computed once a step
//   NAME_between(h0, d, kept)     force, slope, and mean force over the step d, without cancellation
// law_pieces and law_piece (LawPiece: at, value, slope, second, third, integral of components/cubic_pieces.h) are the rows of the law `table`.
// REAL is float or double; abs and sqrt are of both. Both sides of a condition are computed and law_select takes one, so that the loops over
// vertices have no branches. law_exp, law_expm1 (e^x - 1) and law_second ((e^x - 1 - x) / x^2, from x and e^x - 1) are
// the platform's.

struct LawAt {
  REAL force;           // at h1 = h0 + d
  REAL slope;           // at h1
  REAL gradient;        // mean force between h0 and h1: the discrete gradient
  REAL gradient_slope;  // its derivative by h1
};

SHARED LawAt law_at(REAL force, REAL slope, REAL gradient, REAL gradient_slope) {
  LawAt at;
  at.force = force;
  at.slope = slope;
  at.gradient = gradient;
  at.gradient_slope = gradient_slope;
  return at;
}

// Linear: F = h.
SHARED REAL linear_force(REAL h, LawConstants k) { return h; }
SHARED REAL linear_slope(REAL h, LawConstants k) { return 1.0; }
SHARED REAL linear_potential(REAL h, LawConstants k) { return 0.5 * h * h; }
SHARED REAL linear_keep(REAL h0, LawConstants k) { return 0.0; }
SHARED LawAt linear_between(REAL h0, REAL d, REAL kept, LawConstants k) {
  return law_at(h0 + d, 1.0, 0.5 * (h0 + (h0 + d)), 0.5);
}

// Cubic: F = h + (k3 / k) h^3.
SHARED REAL cubic_force(REAL h, LawConstants k) { return h + k.cubic * h * h * h; }
SHARED REAL cubic_slope(REAL h, LawConstants k) { return 1.0 + 3.0 * k.cubic * h * h; }
SHARED REAL cubic_potential(REAL h, LawConstants k) { return h * h * (0.5 + 0.25 * k.cubic * h * h); }
SHARED REAL cubic_keep(REAL h0, LawConstants k) { return 0.0; }
SHARED LawAt cubic_between(REAL h0, REAL d, REAL kept, LawConstants k) {
  REAL h1 = h0 + d;
  REAL sum = h0 + h1;
  REAL squares = h0 * h0 + h1 * h1;
  return law_at(cubic_force(h1, k), cubic_slope(h1, k), 0.5 * sum + 0.25 * k.cubic * sum * squares,
                0.5 + 0.25 * k.cubic * (squares + 2.0 * sum * h1));
}

// Exponential: F = (1 - e^(-alpha h)) / alpha where pushed in, linear where it bulges. Differences of exponentials are
// written with e^x - 1 throughout, to avoid cancellation near rest.
SHARED REAL exponential_force(REAL h, LawConstants k) {
  return law_select(h < 0.0, -law_expm1(-k.stiffening * h) / k.stiffening, h);
}
SHARED REAL exponential_slope(REAL h, LawConstants k) { return law_select(h < 0.0, law_exp(-k.stiffening * h), 1.0); }
SHARED REAL exponential_potential(REAL h, LawConstants k) {
  REAL x = -k.stiffening * h;
  REAL over = law_select(abs(x) < 0.001, x * x * (0.5 + x / 6.0 + x * x / 24.0), law_expm1(x) - x);
  return law_select(h < 0.0, over / (k.stiffening * k.stiffening), 0.5 * h * h);
}
SHARED REAL exponential_keep(REAL h0, LawConstants k) { return law_expm1(-k.stiffening * h0); }
SHARED LawAt exponential_between(REAL h0, REAL d, REAL em0, LawConstants k) {
  REAL h1 = h0 + d;
  REAL x = -k.stiffening * d;
  REAL em = law_expm1(x);
  REAL em1 = em0 * (1.0 + em) + em;  // e^(-alpha h1) - 1
  REAL force1 = law_select(h1 < 0.0, -em1 / k.stiffening, h1);
  REAL slope1 = law_select(h1 < 0.0, 1.0 + em1, 1.0);
  // Both below zero: -(1/alpha) (e^(-alpha h0) (e^x - 1)/x - 1). Across the kink: (U1 - U0)/d, where one U is
  // exponential. Both above: linear. One evaluation of law_second serves all cases.
  REAL curved = law_second(law_select(h0 < 0.0, law_select(h1 < 0.0, x, -k.stiffening * h0), -k.stiffening * h1),
                           law_select(h0 < 0.0, law_select(h1 < 0.0, em, em0), em1));
  REAL rise = x * curved;
  REAL below = -(em0 * (1.0 + rise) + rise) / k.stiffening;
  REAL above = 0.5 * (h0 + h1);
  REAL over_d = 1.0 / law_select(d == 0.0, 1.0, d);
  REAL U0 = h0 * h0 * law_select(h0 < 0.0, curved, 0.5);
  REAL U1 = h1 * h1 * law_select(h1 < 0.0, curved, 0.5);
  REAL across = (U1 - U0) * over_d;
  REAL gradient = law_select(h0 < 0.0, law_select(h1 < 0.0, below, across), law_select(h1 < 0.0, across, above));
  bool short_step = abs(d) <= 1e-7 * (abs(h0) + abs(h1));
  return law_at(force1, slope1, gradient, law_select(short_step, 0.5 * slope1, (force1 - gradient) * over_d));
}

// Table: a monotone cubic through the author's rows, per the slope at 0; linear where it bulges and beyond the last row.
// x = -h. The law finds its piece by counting, and has branches: the loops over vertices take it one by one.
SHARED int table_find(REAL x, LawConstants k) {
  int found = 0;
  for (int i = 0; i < law_pieces(k); ++i) {
    if (x >= law_piece(i, k).at) ++found;
  }
  return found;
}
// The first piece is the bulge's.
SHARED LawPiece table_piece(int number, LawConstants k) {
  if (number > 0) return law_piece(number - 1, k);
  LawPiece bulge;
  bulge.at = 0.0;
  bulge.value = 0.0;
  bulge.slope = 1.0;
  bulge.second = 0.0;
  bulge.third = 0.0;
  bulge.integral = 0.0;
  return bulge;
}
SHARED REAL piece_value(LawPiece p, REAL t) { return p.value + t * (p.slope + t * (p.second + t * p.third)); }
SHARED REAL piece_slope(LawPiece p, REAL t) { return p.slope + t * (2.0 * p.second + 3.0 * t * p.third); }
// Mean of the value between two places.
SHARED REAL piece_mean(LawPiece p, REAL a, REAL b) {
  return p.value + 0.5 * p.slope * (a + b) + p.second * (a * a + a * b + b * b) / 3.0 +
         0.25 * p.third * (a + b) * (a * a + b * b);
}
SHARED REAL table_force(REAL h, LawConstants k) {
  LawPiece p = table_piece(table_find(-h, k), k);
  return -piece_value(p, -h - p.at);
}
SHARED REAL table_slope(REAL h, LawConstants k) {
  LawPiece p = table_piece(table_find(-h, k), k);
  return piece_slope(p, -h - p.at);
}
SHARED REAL table_potential(REAL h, LawConstants k) {
  LawPiece p = table_piece(table_find(-h, k), k);
  REAL t = -h - p.at;
  return p.integral + t * piece_mean(p, 0.0, t);
}
SHARED REAL table_keep(REAL h0, LawConstants k) { return 0.0; }
SHARED LawAt table_between(REAL h0, REAL d, REAL kept, LawConstants k) {
  REAL x0 = -h0;
  REAL x1 = -(h0 + d);
  int n0 = table_find(x0, k);
  int n1 = table_find(x1, k);
  LawPiece p1 = table_piece(n1, k);
  REAL force1 = -piece_value(p1, x1 - p1.at);
  REAL slope1 = piece_slope(p1, x1 - p1.at);
  // Over several pieces the mean is that of its parts, by their lengths: without cancellation, however short they are.
  bool inward = n0 < n1;
  LawPiece low = table_piece(inward ? n0 : n1, k);
  LawPiece high = table_piece(inward ? n1 : n0, k);
  LawPiece next = table_piece((inward ? n0 : n1) + (n0 == n1 ? 0 : 1), k);
  REAL from = inward ? x0 : x1;
  REAL to = inward ? x1 : x0;
  REAL first = next.at - from;
  REAL last = to - high.at;
  REAL parts = first * piece_mean(low, from - low.at, next.at - low.at) + (high.integral - next.integral) +
               last * piece_mean(high, 0.0, last);
  REAL gradient = n0 == n1 ? -piece_mean(p1, x0 - p1.at, x1 - p1.at) : -parts / (first + (high.at - next.at) + last);
  bool short_step = abs(d) <= 1e-7 * (abs(h0) + abs(d));
  return law_at(force1, slope1, gradient, short_step ? 0.5 * slope1 : (force1 - gradient) / d);
}
