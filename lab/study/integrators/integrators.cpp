#include "lab/study/integrators/integrators.h"

#include <algorithm>
#include <cmath>

#include "systems/touch/model/field_kernels.h"

namespace pliant {
namespace {

struct Rate {
  double h, v, q;
};

Rate rate_of(const VertexProblem& p, const VertexState& s) {
  return {s.v, (-p.b * s.v - p.k * p.law.force(s.h) - s.q) / p.m, p.solid() ? p.k1 * s.v - s.q / p.tau : 0.0};
}

VertexState along(const VertexState& s, const Rate& r, double T) {
  return {s.h + T * r.h, s.v + T * r.v, s.q + T * r.q};
}

VertexState runge_kutta(const VertexProblem& p, const VertexState& s, double T) {
  const Rate a = rate_of(p, s), b = rate_of(p, along(s, a, T / 2)), c = rate_of(p, along(s, b, T / 2)),
             d = rate_of(p, along(s, c, T));
  return along(s, {a.h + 2 * b.h + 2 * c.h + d.h, a.v + 2 * b.v + 2 * c.v + d.v, a.q + 2 * b.q + 2 * c.q + d.q}, T / 6);
}

VertexState semi_implicit(const VertexProblem& p, const VertexState& s, double T) {
  const double v = s.v + T * rate_of(p, s).v;
  return {s.h + T * v, v, p.solid() ? s.q + T * (p.k1 * v - s.q / p.tau) : 0.0};
}

// Solves inertia d + spring(d) + constant = 0 for d. The left side is monotonically increasing: Newton's method in a
// bracket, since the spring only shortens the step that mass and damping alone give. spring(d, slope) also returns its
// slope.
template <class Spring>
double solve_step(double inertia, double constant, double h0, const Spring& spring) {
  double slope = 0.0, d = 0.0, r = spring(0.0, slope) + constant;
  const double farthest = -r / inertia;
  double low = std::min(0.0, farthest), high = std::max(0.0, farthest);
  for (int i = 0; i < 60 && r != 0.0; ++i) {
    double next = d - r / (inertia + slope);
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - d) <= 1e-14 * (std::abs(h0) + std::abs(next))) return next;
    d = next;
    r = inertia * d + spring(d, slope) + constant;
    (r > 0 ? high : low) = d;
  }
  return d;
}

// The arm's force at the end of a step, or at its middle, is (q + gain d) / loss.
struct Arm {
  double gain = 0.0, loss = 1.0;
};

VertexState implicit_euler(const VertexProblem& p, const VertexState& s, double T) {
  const Arm arm = p.solid() ? Arm{p.k1, 1 + T / p.tau} : Arm{};
  const double inertia = p.m / (T * T) + p.b / T;
  const double d = solve_step(inertia, -p.m * s.v / T, s.h, [&](double x, double& slope) {
    slope = p.k * p.law.slope(s.h + x) + arm.gain / arm.loss;
    return p.k * p.law.force(s.h + x) + (s.q + arm.gain * x) / arm.loss;
  });
  return {s.h + d, d / T, p.solid() ? (s.q + arm.gain * d) / arm.loss : 0.0};
}

// Both second-order schemes: the spring's mean force over the step is its force at the midpoint, or its discrete
// gradient.
VertexState middle(const VertexProblem& p, const VertexState& s, double T, bool gradient) {
  const Arm arm = p.solid() ? Arm{p.k1 / 2, 1 + T / (2 * p.tau)} : Arm{};
  const double inertia = 2 * p.m / (T * T) + p.b / T;
  const double d = solve_step(inertia, -2 * p.m * s.v / T, s.h, [&](double x, double& slope) {
    const double h1 = s.h + x, of_arm = (s.q + arm.gain * x) / arm.loss;
    double force;
    if (gradient) {
      const bool near = std::abs(x) <= 1e-9 * (std::abs(s.h) + std::abs(h1));
      force = p.law.discrete_gradient(s.h, h1);
      slope = near ? 0.5 * p.law.slope(h1) : (p.law.force(h1) - force) / x;
    } else {
      force = p.law.force(s.h + x / 2);
      slope = 0.5 * p.law.slope(s.h + x / 2);
    }
    slope = p.k * slope + arm.gain / arm.loss;
    return p.k * force + of_arm;
  });
  return {s.h + d, 2 * d / T - s.v, p.solid() ? 2 * (s.q + arm.gain * d) / arm.loss - s.q : 0.0};
}

VertexState product(const std::array<std::array<double, 3>, 3>& E, const VertexState& s) {
  return {E[0][0] * s.h + E[0][1] * s.v + E[0][2] * s.q, E[1][0] * s.h + E[1][1] * s.v + E[1][2] * s.q,
          E[2][0] * s.h + E[2][1] * s.v + E[2][2] * s.q};
}

VertexState tangent(const VertexProblem& p, const VertexState& s, double T) {
  const double kt = p.k * p.law.slope(s.h), f = kt * s.h - p.k * p.law.force(s.h);
  const HeightState next = step_oscillator({s.h, s.v}, p.m, p.b, kt, f, T);
  return {next.height, next.velocity, 0.0};
}

}  // namespace

const char* name_of(Integrator integrator) {
  constexpr const char* kNames[] = {"explicit Euler", "semi-implicit Euler", "implicit Euler", "RK4",
                                    "midpoint",       "discrete gradient",   "exact",          "engine"};
  return kNames[static_cast<std::size_t>(integrator)];
}

VertexProblem vertex_problem(SpringLaw law, double k, double zeta) {
  Deformable d;
  d.spring = law;
  d.cubic *= k / d.stiffness;  // scaled with k, so that the law keeps its shape
  const double arm = d.relaxation_stiffness / d.stiffness;
  d.stiffness = k;
  VertexProblem p;
  p.law = restoring_law(d);
  p.k = k;
  p.b = 2 * zeta * std::sqrt(k * p.m);
  if (law == SpringLaw::kStandardLinearSolid) {
    p.k1 = arm * k;
    p.tau = d.relaxation_time;
  }
  return p;
}

VertexStepper::VertexStepper(Integrator integrator, const VertexProblem& p, double T, std::size_t vertices)
    : integrator_(integrator), problem_(p), T_(T), states_(integrator == Integrator::kEngine ? kZoneSize : vertices) {
  linear_ = exact_step(p.m, p.b, p.k, T);
  if (p.solid()) solid_ = solid_step(p.m, p.b, p.k, p.k1, p.tau, T);
  if (integrator != Integrator::kEngine) return;
  motion_.dt = T;
  motion_.mass = p.m / p.k;
  motion_.damping = p.b / p.k;
  motion_.law = p.law;
  motion_.linear = exact_step(motion_.mass, motion_.damping, 1.0, T);
  if (p.solid()) {
    motion_.arm_stiffness = p.k1 / p.k;
    motion_.arm_time = p.tau;
    motion_.arm_decay = std::exp(-T / p.tau);
    motion_.solid = solid_step(motion_.mass, motion_.damping, 1.0, motion_.arm_stiffness, p.tau, T);
    field_.arm.resize(kZoneSize);
  }
  field_.residual.resize(kZoneSize);
  field_.rate.resize(kZoneSize);
}

void VertexStepper::begin(VertexState state) {
  std::fill(states_.begin(), states_.end(), state);
  if (integrator_ != Integrator::kEngine) return;
  std::fill(field_.residual.begin(), field_.residual.end(), vec4(0, 0, 0, static_cast<float>(state.h)));
  std::fill(field_.rate.begin(), field_.rate.end(), vec4(0, 0, 0, static_cast<float>(state.v)));
  std::fill(field_.arm.begin(), field_.arm.end(), vec4(0, 0, 0, static_cast<float>(state.q / problem_.k)));
}

void VertexStepper::step(int steps) {
  const auto each = [&](const auto& one) {
    for (int i = 0; i < steps; ++i)
      for (VertexState& s : states_) s = one(s);
  };
  const VertexProblem& p = problem_;
  const double T = T_;
  switch (integrator_) {
    case Integrator::kExplicit:
      return each([&](const VertexState& s) { return along(s, rate_of(p, s), T); });
    case Integrator::kSemiImplicit:
      return each([&](const VertexState& s) { return semi_implicit(p, s, T); });
    case Integrator::kImplicit:
      return each([&](const VertexState& s) { return implicit_euler(p, s, T); });
    case Integrator::kRungeKutta:
      return each([&](const VertexState& s) { return runge_kutta(p, s, T); });
    case Integrator::kMidpoint:
      return each([&](const VertexState& s) { return middle(p, s, T, false); });
    case Integrator::kDiscreteGradient:
      return each([&](const VertexState& s) { return middle(p, s, T, true); });
    case Integrator::kExact:
      if (p.solid()) return each([&](const VertexState& s) { return product(solid_, s); });
      if (p.law.curved()) return each([&](const VertexState& s) { return tangent(p, s, T); });
      return each([&](const VertexState& s) {
        return VertexState{linear_.hh * s.h + linear_.hv * s.v, linear_.vh * s.h + linear_.vv * s.v, 0.0};
      });
    case Integrator::kEngine:
      for (int i = 0; i < steps; ++i) step_residual(motion_, {}, field_, 0);
      states_[0] = {field_.residual[0].w, field_.rate[0].w, 0.0};
      return;
  }
}

std::vector<double> true_heights(const VertexProblem& p, double height, double dt, int count) {
  std::vector<double> heights{height};
  if (!p.law.curved()) {
    for (int i = 1; i <= count; ++i)
      heights.push_back(height * (p.solid() ? solid_step(p.m, p.b, p.k, p.k1, p.tau, i * dt)[0][0]
                                            : exact_step(p.m, p.b, p.k, i * dt).hh));
    return heights;
  }
  const double fastest = std::sqrt(p.k * std::max(p.law.slope(height), p.law.slope(-height)) / p.m);
  const double longest = std::min(0.01 / fastest, 0.5 * p.m / std::max(p.b, 1e-300));
  const int parts = std::max(8, static_cast<int>(std::ceil(dt / longest)));  // finer than RK4 at dt
  VertexState s{height, 0.0, 0.0};
  for (int i = 1; i <= count; ++i) {
    for (int k = 0; k < parts; ++k) s = runge_kutta(p, s, dt / parts);
    heights.push_back(s.h);
  }
  return heights;
}

}  // namespace pliant
