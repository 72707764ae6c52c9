#include "systems/touch/model/nonlinear_step.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "runtime/kernel.h"
#include "systems/touch/model/field_kernels.h"
#include "systems/touch/model/spring_arithmetic.h"

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

// A law that ships, in lanes.
#define PLIANT_LAW(word, ...) k_##word,
enum LawPlace : std::size_t { PLIANT_SPRING_LAWS(PLIANT_LAW) };
#undef PLIANT_LAW
#define PLIANT_LAW(word, of, step, ...)                                                \
  struct word##_in_lanes {                                                             \
    static constexpr std::size_t kPlace = k_##word;                                    \
    static constexpr SpringStep kStep = SpringStep::step;                              \
    law_lanes::LawConstants k;                                                         \
    PLIANT_INLINE double force(double h) const { return law_lanes::of##_force(h, k); } \
    PLIANT_INLINE double slope(double h) const { return law_lanes::of##_slope(h, k); } \
    PLIANT_INLINE double keep(double h0) const { return law_lanes::of##_keep(h0, k); } \
    PLIANT_INLINE law_lanes::LawAt at(double h0, double d, double kept) const {        \
      return law_lanes::of##_between(h0, d, kept, k);                                  \
    }                                                                                  \
  };
PLIANT_SPRING_LAWS(PLIANT_LAW)
#undef PLIANT_LAW

// A registered law: one vertex at a time, without SIMD.
struct Own {
  static constexpr SpringStep kStep = SpringStep::kPassive;
  RestoringLaw law;
  double force(double h) const { return law.force(h); }
  double slope(double h) const { return law.slope(h); }
  double keep(double) const { return 0.0; }
  law_lanes::LawAt at(double h0, double d, double) const {
    const double h1 = h0 + d, force1 = law.force(h1), slope1 = law.slope(h1), gradient = law.discrete_gradient(h0, h1);
    const bool short_step = std::abs(d) <= 1e-7 * (std::abs(h0) + std::abs(h1));
    return {force1, slope1, gradient, short_step ? 0.5 * slope1 : (force1 - gradient) / d};
  }
};

struct alignas(64) Work {
  Lanes h0, v0, f, f_slope;
  Lanes mass, damping;    // [s2] m/k, [s] b/k, both over 1 + r1
  Lanes r1, share, held;  // [1] k1/k, 1 / (1 + r1); [m] force of the arm's spring if it had not relaxed, less its own
  Lanes slope0, slope1;   // [1] of the law before and after the step
  Lanes kept, inertia, constant;  // of the residual: inertia d + spring(d) + constant
  Lanes stiff;                    // 1: backward Euler, 0: discrete gradient
  Lanes d, low, high, step;       // step: size of the last Newton step minus the tolerance
};

template <bool kArm, class Law>
PLIANT_INLINE void begin(const Law& law, const Motion& motion, Work& w, bool forced) {
  const double T = motion.dt;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const double target = w.f[i], m = w.mass[i], b = w.damping[i];
    const double own = forced ? law.force(target) : 0.0, f = kArm ? w.share[i] * (own + w.held[i]) : own;
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
    const law_lanes::LawAt s = law.at(h0, d, w.kept[i]);
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
    w.f[i] = law.slope(w.h0[i] + 0.5 * d);
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
// With an arm as step_relaxing.
template <bool kArm>
PLIANT_KERNEL void step_normals(const Motion& motion, const Work& w, const float* __restrict target,
                                float* __restrict n, float* __restrict rate, float* __restrict arm) {
  const double T = motion.dt;
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    const double slope = w.f[i], s = n[i], r = rate[i], m2 = 2 * w.mass[i] / T, b = w.damping[i];
    const double pulled = w.f_slope[i] * target[i];
    const double pull = kArm ? w.share[i] * (pulled + w.r1[i] * w.slope0[i] * s - arm[i]) : pulled;
    const double vm = (m2 * r - slope * s + pull) / (m2 + b + 0.5 * T * slope);
    n[i] = static_cast<float>(s + T * vm);
    if (kArm) arm[i] = static_cast<float>(arm[i] + w.r1[i] * (w.slope1[i] * (s + T * vm) - w.slope0[i] * s));
    rate[i] = static_cast<float>(2 * vm - r);
  }
}

template <bool kArm, class Law>
PLIANT_KERNEL void begin_lanes(const Law& law, const Motion& motion, Work& w, bool forced) {
  begin<kArm>(law, motion, w, forced);
}
template <class Law>
PLIANT_KERNEL void newton_lanes(const Law& law, Work& w) {
  newton(law, w);
}
template <class Law>
PLIANT_KERNEL void finish_lanes(const Law& law, const Motion& motion, Work& w, float* h, float* v) {
  finish(law, motion, w, h, v);
}

// Vertices that have not converged: scalar solver.
void settle(const Motion& motion, const ZoneTargets* targets, bool arm, Work& w) {
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    if (w.step[i] <= 0) continue;
    const double own = targets ? motion.law.force(static_cast<double>(targets->h[i])) : 0.0,
                 f = arm ? w.share[i] * (own + w.held[i]) : own;
    const HeightState start{w.h0[i], w.v0[i]};
    w.d[i] = step_restoring(motion.law, start, w.mass[i], w.damping[i], 1.0, f, motion.dt).height - w.h0[i];
  }
}

// Half a relaxation before the step, and what the arm's spring does in it.
template <class Law>
void begin_arm(const Law& law, const Motion& motion, const PaintedMotion& painted, std::uint32_t zone, Parts& arm,
               Work& w) {
  const float half = static_cast<float>(motion.arm_half);
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    arm.h[i] *= half;
    for (int c = 0; c < 3; ++c) arm.n[c][i] *= half;
    const double r1 = painted.arm.empty() ? motion.arm_stiffness : painted.arm[std::size_t{zone} * kZoneSize + i];
    w.r1[i] = r1;
    w.share[i] = 1 / (1 + r1);
    w.slope0[i] = law.slope(w.h0[i]);
    w.held[i] = r1 * law.force(w.h0[i]) - static_cast<double>(arm.h[i]);
    w.mass[i] *= w.share[i];
    w.damping[i] *= w.share[i];
  }
}

template <class Law>
void end_arm(const Law& law, const Motion& motion, Parts& arm, Work& w) {
  const float half = static_cast<float>(motion.arm_half);
  for (std::uint32_t i = 0; i < kZoneSize; ++i) {
    arm.h[i] = half * static_cast<float>(w.r1[i] * law.force(w.h0[i] + w.d[i]) - w.held[i]);
    w.slope1[i] = law.slope(w.h0[i] + w.d[i]);
  }
}

template <bool kArm, class Law>
void step_heights(const Law& law, const Motion& motion, const ZoneTargets* targets, Work& w, float* h, float* v) {
  begin_lanes<kArm>(law, motion, w, targets != nullptr);
  bool settled = false;
  for (int round = 0; round < kSteps && !settled; ++round) {
    newton_lanes(law, w);
    settled = all_settled(w);
  }
  if (!settled) settle(motion, targets, kArm, w);
  finish_lanes(law, motion, w, h, v);
}

}  // namespace

void step_nonlinear(const Motion& motion, const PaintedMotion& painted, std::uint32_t zone, vec4* state, vec4* rate,
                    vec4* arm, const ZoneTargets* targets) {
  static constexpr float kNothing[kZoneSize] = {};
  const float* const goal[4] = {targets ? targets->nx.data() : kNothing, targets ? targets->ny.data() : kNothing,
                                targets ? targets->nz.data() : kNothing, targets ? targets->h.data() : kNothing};
  Parts s, r, a;
  Work w;
  split(&state->x, s);
  split(&rate->x, r);
  if (arm) split(&arm->x, a);
  widen(s, r, goal[3], w);
  if (painted.mass.empty()) {
    std::fill_n(w.mass, kZoneSize, motion.mass);
    std::fill_n(w.damping, kZoneSize, motion.damping);
  } else {
    std::copy_n(painted.mass.data() + std::size_t{zone} * kZoneSize, kZoneSize, w.mass);
    std::copy_n(painted.damping.data() + std::size_t{zone} * kZoneSize, kZoneSize, w.damping);
  }
  const RestoringLaw& law = motion.law;
  const auto step = [&](const auto& its) {
    constexpr SpringStep kStep = std::decay_t<decltype(its)>::kStep;
    if constexpr (kStep == SpringStep::kPassive) step_heights<false>(its, motion, targets, w, s.h, r.h);
    if constexpr (kStep == SpringStep::kPassiveArm) {
      begin_arm(its, motion, painted, zone, a, w);
      step_heights<true>(its, motion, targets, w, s.h, r.h);
      end_arm(its, motion, a, w);
    }
  };
  const law_lanes::LawConstants constants{law.cubic, {law.stiffening, 1 / law.stiffening}, &law.table};
  switch (static_cast<std::size_t>(law.kind)) {
#define PLIANT_LAW(word, ...)         \
  case word##_in_lanes::kPlace:       \
    step(word##_in_lanes{constants}); \
    break;
    PLIANT_SPRING_LAWS(PLIANT_LAW)
#undef PLIANT_LAW
    default:
      step(Own{law});
  }
  for (int c = 0; c < 3; ++c)
    arm ? step_normals<true>(motion, w, goal[c], s.n[c], r.n[c], a.n[c])
        : step_normals<false>(motion, w, goal[c], s.n[c], r.n[c], nullptr);
  if (arm) {
    for (auto& n : a.n)
      for (float& each : n) each *= static_cast<float>(motion.arm_half);
    join(a, &arm->x);
  }
  join(s, &state->x);
  join(r, &rate->x);
}

}  // namespace pliant
