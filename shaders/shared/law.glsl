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
