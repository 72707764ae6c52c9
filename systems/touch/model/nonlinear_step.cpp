#include "systems/touch/model/nonlinear_step.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "runtime/kernel.h"
#include "systems/touch/model/field_kernels.h"

// Every loop here runs over the vertices of a zone in double, without branches, so that the compiler vectorises it.
// Newton's method takes the same steps as step_restoring(). Vertices that have not converged after kSteps (a bracket
// that must be halved often) are left to it, one by one.

namespace pliant {
namespace {

#define PLIANT_INLINE inline __attribute__((always_inline))

using Lanes = double[kZoneSize];

constexpr int kSteps = 8;
// A Newton step this small, relative to |h0| + |d|, is the last: the remaining error is of the order of its square.
constexpr double kSettledStep = 1e-7;

PLIANT_INLINE double select(bool first, double a, double b) {
  return first ? a : b;
}

// e^x - 1 to a few ulp. x is clamped to the range of double; beyond it the bracket decides.
PLIANT_INLINE double expm1_of(double x) {
  x = select(x < 700.0, x, 700.0);
  x = select(x > -700.0, x, -700.0);
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

// Each law: force and slope at h0, the precomputed value keep(h0), and force, slope and discrete gradient at h1 = h0 +
// d.
struct Spring {
  double force, slope;              // at h1
  double gradient, gradient_slope;  // discrete gradient between h0 and h1, and its derivative by h1
};

struct Cubic {
  double c;
  PLIANT_INLINE double force(double h) const { return h + c * h * h * h; }
  PLIANT_INLINE double slope(double h) const { return 1 + 3 * c * h * h; }
  PLIANT_INLINE double keep(double) const { return 0.0; }
  PLIANT_INLINE double slope_between(double h0, double d, double) const { return slope(h0 + 0.5 * d); }
  PLIANT_INLINE Spring at(double h0, double d, double) const {
    const double h1 = h0 + d, sum = h0 + h1, squares = h0 * h0 + h1 * h1;
    return {force(h1), slope(h1), 0.5 * sum + 0.25 * c * sum * squares, 0.5 + 0.25 * c * (squares + 2 * sum * h1)};
  }
};

// Differences of exponentials are written with e^x - 1 throughout, to avoid cancellation near rest.
struct Exponential {
  double alpha, inv;  // [1/m] [m]
  PLIANT_INLINE double force(double h) const { return select(h < 0, -expm1_of(-alpha * h) * inv, h); }
  PLIANT_INLINE double slope(double h) const { return select(h < 0, 1 + expm1_of(-alpha * h), 1.0); }
  PLIANT_INLINE double keep(double h0) const { return expm1_of(-alpha * h0); }
  PLIANT_INLINE double slope_between(double h0, double d, double) const { return slope(h0 + 0.5 * d); }
  // (e^x - 1 - x) / x^2, by its series where that cancels.
  PLIANT_INLINE static double second(double x, double em1) {
    const double x2 = x * x, x4 = x2 * x2;
    const double series = ((0.5 + x * (1.0 / 6)) + x2 * (1.0 / 24 + x * (1.0 / 120))) +
                          x4 * ((1.0 / 720 + x * (1.0 / 5040)) + x2 * (1.0 / 40320));
    const bool small = std::abs(x) < 0.03;
    return select(small, series, (em1 - x) / select(small, 1.0, x2));
  }
  PLIANT_INLINE Spring at(double h0, double d, double em0) const {
    const double h1 = h0 + d, x = -alpha * d, em = expm1_of(x);
    const double em1 = em0 * (1 + em) + em;  // e^(-alpha h1) - 1
    const double force1 = select(h1 < 0, -em1 * inv, h1), slope1 = select(h1 < 0, 1 + em1, 1.0);
    // Both below zero: -(1/alpha) (e^(-alpha h0) (e^x - 1)/x - 1). Across the kink: (U1 - U0)/d, where one U is
    // exponential. Both above: linear. One evaluation of `second` serves all cases.
    const double curved = second(select(h0 < 0, select(h1 < 0, x, -alpha * h0), -alpha * h1),
                                 select(h0 < 0, select(h1 < 0, em, em0), em1));
    const double rise = x * curved;
    const double below = -(em0 * (1 + rise) + rise) * inv, above = 0.5 * (h0 + h1);
    const double over_d = 1.0 / select(d == 0.0, 1.0, d);
    const double U0 = h0 * h0 * select(h0 < 0, curved, 0.5), U1 = h1 * h1 * select(h1 < 0, curved, 0.5);
    const double across = (U1 - U0) * over_d;
    const double gradient = select(h0 < 0, select(h1 < 0, below, across), select(h1 < 0, across, above));
    const bool short_step = std::abs(d) <= 1e-7 * (std::abs(h0) + std::abs(h1));
    const double gradient_slope = select(short_step, 0.5 * slope1, (force1 - gradient) * over_d);
    return {force1, slope1, gradient, gradient_slope};
  }
};

// A registered law: one vertex at a time, without SIMD.
struct Own {
  RestoringLaw law;
  double force(double h) const { return law.force(h); }
  double slope(double h) const { return law.slope(h); }
  double keep(double) const { return 0.0; }
  double slope_between(double h0, double d, double) const { return law.slope(h0 + 0.5 * d); }
  Spring at(double h0, double d, double) const {
    const double h1 = h0 + d, force1 = law.force(h1), slope1 = law.slope(h1), gradient = law.discrete_gradient(h0, h1);
    const bool short_step = std::abs(d) <= 1e-7 * (std::abs(h0) + std::abs(h1));
    return {force1, slope1, gradient, short_step ? 0.5 * slope1 : (force1 - gradient) / d};
  }
};

struct alignas(64) Work {
  Lanes h0, v0, f, f_slope;
  Lanes mass, damping;            // [s2] m/k, [s] b/k
  Lanes kept, inertia, constant;  // of the residual: inertia d + spring(d) + constant
  Lanes stiff;                    // 1: backward Euler, 0: discrete gradient
  Lanes d, low, high, step;       // step: size of the last Newton step minus the tolerance
};

template <class Law>
PLIANT_INLINE void begin(const Law& law, const Motion& motion, Work& w, bool forced) {
  const double T = motion.dt;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const double target = w.f[i], m = w.mass[i], b = w.damping[i];
    const double f = forced ? law.force(target) : 0.0;
    w.f_slope[i] = forced ? law.slope(target) : 0.0;
    const double h0 = w.h0[i];
    const bool stiff = law.slope(h0) * T * T > 2.25 * m;
    const double whole = select(stiff, 1.0, 2.0) * m / (T * T);
    w.stiff[i] = select(stiff, 1.0, 0.0);
    w.kept[i] = law.keep(h0);
    w.inertia[i] = whole + b / T;
    w.constant[i] = -whole * T * w.v0[i] - f;
    // The spring can only shorten the step that mass and damping alone would make.
    const double r = law.force(h0) + w.constant[i], farthest = -r / w.inertia[i];
    w.low[i] = select(farthest < 0, farthest, 0.0);
    w.high[i] = select(farthest > 0, farthest, 0.0);
    w.d[i] = -r / (w.inertia[i] + select(stiff, 1.0, 0.5) * law.slope(h0));  // Newton's first step, from 0
  }
}

template <class Law>
PLIANT_INLINE void newton(const Law& law, Work& w) {
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const double d = w.d[i], h0 = w.h0[i];
    const Spring s = law.at(h0, d, w.kept[i]);
    const bool stiff = w.stiff[i] > 0;
    const double r = w.inertia[i] * d + select(stiff, s.force, s.gradient) + w.constant[i];
    const double slope = w.inertia[i] + select(stiff, s.slope, s.gradient_slope);
    // The residual increases with d.
    const double low = select(r < 0, d, w.low[i]), high = select(r > 0, d, w.high[i]);
    const double newton = d - r / slope;
    const double allowed = kSettledStep * (std::abs(h0) + std::abs(d));
    double inside = select(newton >= low, newton, low);
    inside = select(inside <= high, inside, high);
    const bool close = std::abs(newton - d) <= allowed;
    w.low[i] = low;
    w.high[i] = high;
    w.d[i] = select(close, inside, select(newton == inside, newton, 0.5 * (low + high)));
    w.step[i] = std::abs(newton - d) - allowed;
  }
}

PLIANT_KERNEL bool all_settled(const Work& w) {
  constexpr std::uint32_t kLanes = 8;
  double most[kLanes] = {};
  for (std::uint32_t i = 0; i < kZoneSize; i += kLanes)
    for (std::uint32_t l = 0; l < kLanes; ++l) most[l] = w.step[i + l] > most[l] ? w.step[i + l] : most[l];
  bool settled = true;
  for (const double step : most) settled = settled && step <= 0;
  return settled;
}

// Writes heights and rates of the step; overwrites `f` with the slope at its middle.
template <class Law>
PLIANT_INLINE void finish(const Law& law, const Motion& motion, Work& w, float* h, float* v) {
  const double T = motion.dt;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const double d = w.d[i], rate = d / T;
    h[i] = static_cast<float>(w.h0[i] + d);
    v[i] = static_cast<float>(select(w.stiff[i] > 0, rate, 2 * rate - w.v0[i]));
    w.f[i] = law.slope_between(w.h0[i], d, w.kept[i]);
  }
}

struct alignas(64) Parts {
  float n[3][kZoneSize], h[kZoneSize];
};

PLIANT_KERNEL void split(const float* __restrict stream, Parts& parts) {
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    parts.n[0][i] = stream[4 * i];
    parts.n[1][i] = stream[4 * i + 1];
    parts.n[2][i] = stream[4 * i + 2];
    parts.h[i] = stream[4 * i + 3];
  }
}

PLIANT_KERNEL void join(const Parts& parts, float* __restrict stream) {
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    stream[4 * i] = parts.n[0][i];
    stream[4 * i + 1] = parts.n[1][i];
    stream[4 * i + 2] = parts.n[2][i];
    stream[4 * i + 3] = parts.h[i];
  }
}

PLIANT_KERNEL void widen(const Parts& state, const Parts& rate, const float* __restrict target, Work& w) {
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    w.h0[i] = state.h[i];
    w.v0[i] = rate.h[i];
    w.f[i] = target[i];
  }
}

// 2 m (vm - v0)/T + b vm + slope (n0 + T vm / 2) = f_n, with vm the mean rate of the step.
PLIANT_KERNEL void step_normals(const Motion& motion, const Work& w, const float* __restrict target,
                                float* __restrict n, float* __restrict rate) {
  const double T = motion.dt;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const double slope = w.f[i], s = n[i], r = rate[i], m2 = 2 * w.mass[i] / T, b = w.damping[i];
    const double vm = (m2 * r - slope * s + w.f_slope[i] * target[i]) / (m2 + b + 0.5 * T * slope);
    n[i] = static_cast<float>(s + T * vm);
    rate[i] = static_cast<float>(2 * vm - r);
  }
}

PLIANT_KERNEL void begin_cubic(const Cubic& law, const Motion& motion, Work& w, bool forced) {
  begin(law, motion, w, forced);
}
PLIANT_KERNEL void newton_cubic(const Cubic& law, Work& w) {
  newton(law, w);
}
PLIANT_KERNEL void finish_cubic(const Cubic& law, const Motion& motion, Work& w, float* h, float* v) {
  finish(law, motion, w, h, v);
}
PLIANT_KERNEL void begin_exponential(const Exponential& law, const Motion& motion, Work& w, bool forced) {
  begin(law, motion, w, forced);
}
PLIANT_KERNEL void newton_exponential(const Exponential& law, Work& w) {
  newton(law, w);
}
PLIANT_KERNEL void finish_exponential(const Exponential& law, const Motion& motion, Work& w, float* h, float* v) {
  finish(law, motion, w, h, v);
}

void begin_own(const Own& law, const Motion& motion, Work& w, bool forced) {
  begin(law, motion, w, forced);
}
void newton_own(const Own& law, Work& w) {
  newton(law, w);
}
void finish_own(const Own& law, const Motion& motion, Work& w, float* h, float* v) {
  finish(law, motion, w, h, v);
}

// Vertices that have not converged: scalar solver.
void settle(const Motion& motion, const ZoneTargets* targets, Work& w) {
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    if (w.step[i] <= 0) continue;
    const double f = targets ? motion.law.force(static_cast<double>(targets->h[i])) : 0.0;
    const HeightState start{w.h0[i], w.v0[i]};
    w.d[i] = step_restoring(motion.law, start, w.mass[i], w.damping[i], 1.0, f, motion.dt).height - w.h0[i];
  }
}

}  // namespace

void step_nonlinear(const Motion& motion, const PaintedMotion& painted, std::uint32_t zone, vec4* state, vec4* rate,
                    const ZoneTargets* targets) {
  static constexpr float kNothing[kZoneSize] = {};
  const float* const goal[4] = {targets ? targets->nx.data() : kNothing, targets ? targets->ny.data() : kNothing,
                                targets ? targets->nz.data() : kNothing, targets ? targets->h.data() : kNothing};
  Parts s, r;
  Work w;
  split(&state->x, s);
  split(&rate->x, r);
  widen(s, r, goal[3], w);
  if (painted.mass.empty()) {
    std::fill_n(w.mass, kZoneSize, motion.mass);
    std::fill_n(w.damping, kZoneSize, motion.damping);
  } else {
    std::copy_n(painted.mass.data() + std::size_t{zone} * kZoneSize, kZoneSize, w.mass);
    std::copy_n(painted.damping.data() + std::size_t{zone} * kZoneSize, kZoneSize, w.damping);
  }
  const bool forced = targets != nullptr;
  const auto step = [&](const auto& law, auto first, auto next, auto last) {
    first(law, motion, w, forced);
    bool settled = false;
    for (int round = 0; round < kSteps && !settled; ++round) {
      next(law, w);
      settled = all_settled(w);
    }
    if (!settled) settle(motion, targets, w);
    last(law, motion, w, s.h, r.h);
  };
  const RestoringLaw& law = motion.law;
  if (law.own) {
    step(Own{law}, begin_own, newton_own, finish_own);
  } else if (law.kind == SpringLaw::kCubic) {
    step(Cubic{law.cubic}, begin_cubic, newton_cubic, finish_cubic);
  } else {
    step(Exponential{law.stiffening, 1 / law.stiffening}, begin_exponential, newton_exponential, finish_exponential);
  }
  for (int c = 0; c < 3; ++c) step_normals(motion, w, goal[c], s.n[c], r.n[c]);
  join(s, &state->x);
  join(r, &rate->x);
}

}  // namespace pliant
