#include "devices/simulated/wall_theory.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pliant {
namespace {

using Polynomial = std::vector<double>;  // c[0] + c[1] z + ...

Polynomial times(const Polynomial& a, const Polynomial& b) {
  Polynomial product(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  return product;
}

Polynomial plus(Polynomial a, const Polynomial& b) {
  a.resize(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < b.size(); ++i) a[i] += b[i];
  return a;
}

// All roots within the unit circle: the Schur-Cohn recursion, each degree from the next higher one.
bool within_unit_circle(Polynomial c) {
  while (c.size() > 1) {
    const std::size_t n = c.size() - 1;
    const double size = std::abs(c[n]);
    if (!(std::abs(c[0]) < size)) return false;
    Polynomial lower(n);
    for (std::size_t i = 0; i < n; ++i) lower[i] = (c[n] * c[i + 1] - c[0] * c[n - 1 - i]) / (size * size);
    c = std::move(lower);
  }
  return true;
}

// Response after `t` to a constant force of one newton: position [m] and velocity [m/s].
dvec2 response(double m, double b, double t) {
  if (!(b > 0.0)) return {0.5 * t * t / m, t / m};
  const double rise = -std::expm1(-b * t / m);
  return {t / b - m / (b * b) * rise, rise / b};
}

}  // namespace

bool linearly_stable(const WallPlant& plant, const Wall& wall, double radius) {
  const double m = plant.mass, b = plant.damping, T = plant.period;
  const double a = std::exp(-b * T / m), p = b > 0.0 ? m / b * -std::expm1(-b * T / m) : T;
  const double periods = plant.delay / T;
  auto whole = static_cast<std::size_t>(periods + 1e-9);
  const double fraction = std::max(0.0, periods - static_cast<double>(whole)) * T;  // [s]
  const dvec2 after = response(m, b, T - fraction), all = response(m, b, T);
  const double g1 = after.x, h1 = after.y;
  const double g0 = fraction > 1e-12 * T ? all.x - g1 : 0.0, h0 = fraction > 1e-12 * T ? all.y - h1 : 0.0;
  // Divided by z if there is no fractional delay: a root at zero is irrelevant.
  Polynomial free = times({-1.0, 1.0}, {-a, 1.0});
  Polynomial shift(whole + 3, 0.0);
  shift[whole + 2] = T;
  free = times(free, shift);
  const Polynomial law{-wall.damping, wall.stiffness * T + wall.damping};
  const Polynomial plant_response = plus({p * h0 - a * g0, g0 + p * h1 - a * g1}, {0.0, 0.0, g1});
  Polynomial c = plus(free, times(law, plant_response));
  double factor = 1.0;
  for (double& coefficient : c) coefficient *= factor, factor *= radius;
  return within_unit_circle(c);
}

double stability_limit(const WallPlant& plant, double wall_damping) {
  double low = 1e-3, high = low;
  if (!linearly_stable(plant, {low, wall_damping})) return 0.0;
  while (linearly_stable(plant, {high, wall_damping}) && high < 1e9) low = high, high *= 1.02;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (linearly_stable(plant, {middle, wall_damping}) ? low : high) = middle;
  }
  return low;
}

bool passive(const WallPlant& plant, const Wall& wall) {
  return plant.damping > wall.stiffness * (0.5 * plant.period + plant.delay) + std::abs(wall.damping);
}

double passivity_limit(const WallPlant& plant, double wall_damping) {
  return std::max(0.0, (plant.damping - std::abs(wall_damping)) / (0.5 * plant.period + plant.delay));
}

double quantisation_limit(const WallPlant& plant) {
  return plant.encoder > 0.0 ? 2.0 * plant.friction / plant.encoder : std::numeric_limits<double>::infinity();
}

WallBalance balance(const WallPlant& plant, double stiffness) {
  const double viscous = plant.damping - stiffness * (0.5 * plant.period + plant.delay);
  const double dry = plant.friction - 0.5 * stiffness * plant.encoder;
  if (viscous >= 0.0 && dry >= 0.0) return {WallRegime::kDissipative, 0.0};
  if (viscous > 0.0) return {WallRegime::kCycle, -dry / viscous};
  if (dry > 0.0) return {WallRegime::kLocal, -dry / viscous};
  return {WallRegime::kUnstable, 0.0};
}

const char* name_of(WallRegime regime) {
  switch (regime) {
    case WallRegime::kDissipative:
      return "dissipative";
    case WallRegime::kCycle:
      return "limit cycle";
    case WallRegime::kLocal:
      return "locally stable";
    case WallRegime::kUnstable:
      return "unstable";
  }
  return "";
}

}  // namespace pliant
