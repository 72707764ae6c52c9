#include "systems/touch/model/local_model.h"

#include <fmt/format.h>

#include <cmath>

#include "runtime/assert.h"
#include "systems/touch/model/spring_arithmetic.h"

namespace pliant {

StepCoefficients exact_step(double m, double b, double k, double T) {
  if (m == 0.0) {
    if (b == 0.0) return {0, 0, 0, 0};  // only a spring: at equilibrium at once
    const double E = std::exp(-k * T / b);
    return {E, 0, -k / b * E, 0};
  }
  const double a = b / (2 * m), w2 = k / m, D = a * a - w2;
  const double y = D * T * T;
  double C, S;  // e^(-aT) cosh(sqrt(D) T) and e^(-aT) sinh(sqrt(D) T) / sqrt(D)
  if (std::abs(y) < 1e-6) {
    const double E = std::exp(-a * T);
    C = E * (1 + y / 2 + y * y / 24);
    S = E * T * (1 + y / 6 + y * y / 120);
  } else if (D < 0) {
    const double w = std::sqrt(-D), E = std::exp(-a * T);
    C = E * std::cos(w * T);
    S = E * std::sin(w * T) / w;
  } else {
    const double s = std::sqrt(D);
    const double r1 = -w2 / (s + a), r2 = -(s + a);  // r1 written so that a - s does not cancel
    const double e1 = std::exp(r1 * T), e2 = std::exp(r2 * T);
    // C + aS = (r1 e2 - r2 e1) / 2s and C - aS = (r1 e1 - r2 e2) / 2s, again without cancellation.
    S = (e1 - e2) / (2 * s);
    return {(r1 * e2 - r2 * e1) / (2 * s), S, -w2 * S, (r1 * e1 - r2 * e2) / (2 * s)};
  }
  return {C + a * S, S, -w2 * S, C - a * S};
}

HeightState step_oscillator(HeightState state, double m, double b, double k, double f, double T) {
  const auto [h, v] = state;
  if (k == 0.0) {
    if (m == 0.0) return b == 0.0 ? state : HeightState{h + f / b * T, f / b};
    if (b == 0.0) return {h + v * T + 0.5 * f / m * T * T, v + f / m * T};
    const double lost = -std::expm1(-b * T / m);  // 1 - E
    return {h + lost * (m / b) * v + (T - lost * m / b) * f / b, v - lost * v + lost * f / b};
  }
  const StepCoefficients c = exact_step(m, b, k, T);
  const double x = h - f / k;
  return {f / k + c.hh * x + c.hv * v, c.vh * x + c.vv * v};
}

std::array<std::array<double, 3>, 3> solid_step(double m, double b, double k, double k1, double tau, double T) {
  using Matrix = std::array<std::array<double, 3>, 3>;
  const auto multiply = [](const Matrix& x, const Matrix& y) {
    Matrix z{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l) z[i][j] += x[i][l] * y[l][j];
    return z;
  };
  const Matrix A{{{0, T, 0}, {-k / m * T, -b / m * T, -T / m}, {0, k1 * T, -T / tau}}};
  double norm = 0.0;
  for (const auto& row : A) norm = std::max(norm, std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
  // Scaling and squaring of the Taylor series: enough terms for double precision at norm 1/2.
  int squarings = 0;
  double scale = 1.0;
  for (; norm * scale > 0.5; ++squarings) scale *= 0.5;
  Matrix term{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, sum = term, scaled = A;
  for (auto& row : scaled)
    for (double& value : row) value *= scale;
  for (int n = 1; n <= 18; ++n) {
    term = multiply(term, scaled);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum[i][j] += (term[i][j] /= n);
  }
  for (; squarings > 0; --squarings) sum = multiply(sum, sum);
  return sum;
}

double natural_frequency(double zeta, double settling_time) {
  if (zeta == 0.0) return 5.83 / settling_time;
  // The slowest part of the response from rest, |x| = 0.02. Light damping: closed-form envelope. Else the last crossing
  // of the exact response, in units of 1/w0.
  if (zeta < 0.1) return -std::log(0.02) / zeta / settling_time;
  const double slowest = zeta > 1.0 ? 1.0 / (zeta + std::sqrt(zeta * zeta - 1.0)) : zeta;
  const auto above = [&](double t) { return std::abs(exact_step(1.0, 2 * zeta, 1.0, t).hh) > 0.02; };
  const double step = 8.0 / slowest / 1000;
  double low = 1000 * step;
  while (low > step && !above(low)) low -= step;
  double high = low + step;
  for (int i = 0; i < 50; ++i) {
    const double t = 0.5 * (low + high);
    (above(t) ? low : high) = t;
  }
  return low / settling_time;
}

double creep_ratio(double w0, double settling_time) {
  // From rest, x(t) = (r2 e^(-r1 t) - r1 e^(-r2 t)) / (r2 - r1) with r1 r2 = w0^2; the slower r1, by bisection.
  double low = 0.0, high = w0;
  for (int i = 0; i < 100; ++i) {
    const double r1 = 0.5 * (low + high), r2 = w0 * w0 / r1;
    const double left = (r2 * std::exp(-r1 * settling_time) - r1 * std::exp(-r2 * settling_time)) / (r2 - r1);
    (left > 0.02 ? low : high) = r1;
  }
  const double r1 = 0.5 * (low + high);
  return 0.5 * (r1 + w0 * w0 / r1) / w0;
}

double damping_of(const Deformable& d) {
  const bool slow = natural_frequency(d.damping_ratio, d.settling_time) < kSlowest;
  return slow ? creep_ratio(kSlowest, d.settling_time) : d.damping_ratio;
}

namespace {

// The laws that ship, behind the interface of registered ones.
#define PLIANT_LAW(word, of, ...)                                                                               \
  struct word##_spring final : SpringFunction {                                                                 \
    static law_exact::LawConstants at(const SpringConstants& c) { return {c.cubic, c.stiffening, c.table}; }    \
    double force(double h, const SpringConstants& c) const override { return law_exact::of##_force(h, at(c)); } \
    double potential(double h, const SpringConstants& c) const override {                                       \
      return law_exact::of##_potential(h, at(c));                                                               \
    }                                                                                                           \
    double slope(double h, const SpringConstants& c) const override { return law_exact::of##_slope(h, at(c)); } \
    double mean_force(double h0, double h1, const SpringConstants& c) const override {                          \
      return law_exact::of##_between(h0, h1 - h0, law_exact::of##_keep(h0, at(c)), at(c)).gradient;             \
    }                                                                                                           \
  };
PLIANT_SPRING_LAWS(PLIANT_LAW)
#undef PLIANT_LAW

}  // namespace

const SpringFunction& spring_function(SpringLaw law) {
#define PLIANT_LAW(word, ...) new word##_spring,
  static const SpringFunction* const kShipped[] = {PLIANT_SPRING_LAWS(PLIANT_LAW)};
#undef PLIANT_LAW
  const auto place = static_cast<std::size_t>(law);
  if (place < std::size(kShipped)) return *kShipped[place];
  const SpringFunction* const own = registered_spring(law);
  ASSERT(own != nullptr);
  return *own;
}

double exponential_alpha(double stiffening) {
  constexpr double kLinear = 1e-6;
  return std::abs(stiffening) < kLinear ? kLinear : stiffening;
}

RestoringLaw restoring_law(const Deformable& deformable) {
  RestoringLaw out{deformable.spring, deformable.cubic / deformable.stiffness,
                   exponential_alpha(deformable.stiffening)};
  if (reads_key(deformable.spring, "table")) out.table = monotone_cubic(deformable.table, deformable.stiffness);
  return out;
}

double RestoringLaw::height_of(double wanted) const {
  if (!curved() || wanted == 0.0) return wanted;
  double near = 0.0, far = wanted;  // of the same sign, as the force
  for (int i = 0; i < 60 && std::abs(force(far)) < std::abs(wanted); ++i)
    far *= 2;  // a softening law may never have it
  double h = far;
  for (int i = 0; i < 100 && std::abs(far - near) > 1e-14 * std::abs(far); ++i) {
    const double r = force(h) - wanted;
    (std::abs(force(h)) < std::abs(wanted) ? near : far) = h;
    const double next = h - r / slope(h);
    if (std::abs(next - h) <= 1e-14 * std::abs(h)) return h;
    h = (next - near) * (next - far) < 0.0 && i % 3 != 2 ? next : 0.5 * (near + far);
  }
  return h;
}

HeightState step_restoring(const RestoringLaw& law, HeightState state, double m, double b, double k, double f,
                           double T) {
  const auto [h0, v0] = state;
  const double slope = law.slope(h0);
  const bool stiff = k * slope * T * T > 2.25 * m;
  // Residual of the step as a function of d = h1 - h0, and its derivative. Newton with bisection as a fallback: an
  // exponential spring can throw a plain Newton step far away.
  const auto residual = [&, h0 = h0, v0 = v0](double d, double& derivative) {
    const double h1 = h0 + d;
    if (stiff) {
      derivative = m / (T * T) + b / T + k * law.slope(h1);
      return m * (d / T - v0) / T + b * d / T + k * law.force(h1) - f;
    }
    // dG/dh1 is (F(h1) - G) / d, close to half the slope when d is small.
    const double G = law.discrete_gradient(h0, h1);
    const double dG =
        std::abs(d) > 1e-9 * (std::abs(h0) + std::abs(h1)) ? (law.force(h1) - G) / d : 0.5 * law.slope(h1);
    derivative = 2 * m / (T * T) + b / T + k * dG;
    return m * (2 * d / T - 2 * v0) / T + b * d / T + k * G - f;
  };
  // The spring can only shorten the step that mass and damping alone would make: d is between 0 and that step.
  double derivative = 0.0, d = 0.0;
  double r = residual(d, derivative);
  const double farthest = -r / ((stiff ? 1 : 2) * m / (T * T) + b / T);
  double low = std::min(0.0, farthest), high = std::max(0.0, farthest);
  for (int i = 0; i < 100 && r != 0.0; ++i) {
    double next = d - r / derivative;
    // Between a slope that rises and one that falls, Newton's steps may go to and fro.
    const bool cycles = i >= 12 && i % 2 == 0;
    if (!(next >= low && next <= high) || cycles) next = 0.5 * (low + high);
    if (std::abs(next - d) <= 1e-15 * (std::abs(h0) + std::abs(next))) break;
    d = next;
    r = residual(d, derivative);
    (r > 0 ? high : low) = d;  // the residual increases with d
  }
  return stiff ? HeightState{h0 + d, d / T} : HeightState{h0 + d, 2 * d / T - v0};
}

SolidState step_relaxing(const RestoringLaw& law, SolidState s, double m, double b, double r1, double half_decay,
                         double f, double T) {
  const double share = 1 / (1 + r1), lost = r1 * law.force(s.height) - s.arm * half_decay;
  const HeightState y = step_restoring(law, {s.height, s.velocity}, m * share, b * share, 1.0, (f + lost) * share, T);
  return {y.height, y.velocity, (r1 * law.force(y.height) - lost) * half_decay};
}

namespace {

double free_frequency(const Deformable& d) {
  return std::max(kSlowest, natural_frequency(d.damping_ratio, d.settling_time));
}

}  // namespace

double free_damping(const Deformable& deformable) {
  return 2 * damping_of(deformable) / free_frequency(deformable);
}

Motion motion(const Deformable& deformable, double dt) {
  Motion result;
  result.dt = dt;
  const double w0 = free_frequency(deformable);
  result.mass = 1.0 / (w0 * w0);
  result.damping = free_damping(deformable);
  result.law = restoring_law(deformable);
  result.linear = exact_step(result.mass, result.damping, 1.0, dt);
  if (has_arm(deformable.spring)) {
    result.arm_stiffness = deformable.relaxation_stiffness / deformable.stiffness;
    result.arm_time = deformable.relaxation_time;
    result.arm_decay = std::exp(-dt / deformable.relaxation_time);
    result.arm_half = std::exp(-0.5 * dt / deformable.relaxation_time);
    if (!result.law.curved())
      result.solid = solid_step(result.mass, result.damping, 1.0, result.arm_stiffness, result.arm_time, dt);
  }
  if (deformable.young > 0.0 && deformable.thickness > 0.0)
    result.sphere = layer_sphere(deformable.poisson);
  else if (deformable.young > 0.0 && deformable.sphere == SphereForce::kSneddon)
    result.sphere = sneddon_sphere();
  return result;
}

namespace {

// The first layer with a value out of its range.
Status check_layers(const Layers& layers, const std::string& name) {
  using R = DeformableRange;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const Layer& layer = layers[i];
    const bool good = R::kLayerThickness.holds(layer.thickness) && R::kStiffness.holds(layer.stiffness) &&
                      R::kBreakingForce.holds(layer.force) && R::kBreakingEnergy.holds(layer.energy) &&
                      R::kRemains.holds(layer.remains) && R::kGrip.holds(layer.grip);
    if (!good)
      return Error{fmt::format("`{}`: layers", name), fmt::format("layer {} has a value out of its range", i),
                   "give numbers within the ranges of docs/level-format.md"};
  }
  return Done{};
}

}  // namespace

Status check(const Deformable& d, const std::string& name) {
  using R = DeformableRange;
  struct Bound {
    const char* key;
    double value;
    Range range;
    const char* why = "";
  };
  const Bound bounds[] = {
      {"stiffness", d.stiffness, R::kStiffness},
      {"cubic", d.cubic, R::kCubic},
      {"stiffening", d.stiffening, R::kStiffening},
      {"relaxation.stiffness", d.relaxation_stiffness, R::kRelaxationStiffness},
      {"relaxation.time", d.relaxation_time, R::kRelaxationTime},
      {"damping_ratio", d.damping_ratio, R::kDampingRatio},
      {"settling_time", d.settling_time, R::kSettlingTime},
      {"contact_damping", d.contact_damping, R::kContactDamping},
      {"reach", d.reach, {R::kReach.min, R::kReach.max, /*above_min*/ true}},  // spawn has replaced 0
      {"volume", d.volume, R::kVolume},
      {"contact_radius", d.contact_radius, {R::kContactRadius.min, kMostContactShare * d.reach}, ", 0.95 of its reach"},
      {"friction_static", d.friction_static, kFrictionRange},
      {"friction_sliding", d.friction_sliding, {kFrictionRange.min, d.friction_static}},
      {"friction_stribeck", d.friction_stribeck, R::kStribeck},
      {"friction_viscous", d.friction_viscous, R::kViscous},
      {"texture.amplitude", d.texture_amplitude, R::kTextureAmplitude},
      {"texture.wavelength", d.texture_wavelength, R::kTextureWavelength},
      {"texture.seed", d.texture_seed, R::kTextureSeed},
      {"transient.amplitude", d.transient_amplitude, R::kTransientAmplitude},
      {"transient.frequency", d.transient_frequency, R::kTransientFrequency},
      {"transient.decay", d.transient_decay, R::kTransientDecay},
      {"relief", d.relief, R::kRelief},
      {"hole_radius", d.hole_radius, R::kHoleRadius},
      {"yield.force", d.yield_force, R::kYieldForce},
      {"yield.hardening", d.yield_hardening, R::kHardening},
  };
  for (const Bound& bound : bounds) {
    if (bound.range.holds(bound.value)) continue;
    return Error{fmt::format("`{}`: {}", name, bound.key), fmt::format("is {}", bound.value),
                 fmt::format("give a number {} {} to {}{}", bound.range.above_min ? "above" : "from", bound.range.min,
                             bound.range.max, bound.why)};
  }
  if (Status layers = check_layers(d.layers, name); !layers) return layers;
  if (!reads_key(d.spring, "table") && d.table.count == 0) return Done{};
  if (const char* const fault = fault_of(d.table))
    return Error{fmt::format("`{}`: table", name), fault, "give rows of depth and force that rise from 0, 0"};
  if (d.young > 0.0 && reads_key(d.spring, "table"))
    return Error{fmt::format("`{}`: table", name), "stands beside young", "keep one: both say the force"};
  return Done{};
}

}  // namespace pliant
