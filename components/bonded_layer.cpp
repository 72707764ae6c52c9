#include "components/bonded_layer.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pliant {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLargestZ = 24.0;  // of z, from which 1 - L is below rounding

}  // namespace

// Roots of the polynomial by Newton's method.
GaussRule gauss_rule(int n) {
  GaussRule out{std::vector<double>(static_cast<std::size_t>(n)), std::vector<double>(static_cast<std::size_t>(n))};
  for (int i = 0; i < n; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (n + 0.5)), slope = 0.0;
    for (int k = 0; k < 50; ++k) {
      double p = 1.0, before = 0.0;
      for (int j = 1; j <= n; ++j) {
        const double next = ((2 * j - 1) * x * p - (j - 1) * before) / j;
        before = p;
        p = next;
      }
      slope = n * (x * p - before) / (x * x - 1);
      const double step = p / slope;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    out.at[static_cast<std::size_t>(i)] = 0.5 * (1 - x);
    out.weight[static_cast<std::size_t>(i)] = 1 / ((1 - x * x) * slope * slope);
  }
  return out;
}

// In terms of e^(-2z) to avoid overflow.
double missing_of_layer(double z, double poisson) {
  const double k = 3 - 4 * poisson;
  const double e = std::exp(-2 * z), sinh2 = (1 - e * e) / 2, cosh2 = (1 + e * e) / 2;
  const double below = 2 * k * cosh2 + (1 + k * k + 4 * z * z) * e;
  return (2 * k * (cosh2 - sinh2) + (1 + k * k + 4 * z * z + 4 * z) * e) / below;
}

namespace {

// Fredholm's equation at the points of a Gauss rule, for the right sides 1 and t^2.
struct LayerEquation {
  GaussRule t, z;
  std::vector<double> at, weight;  // x, and 2 / pi (1 - L) dx
  std::vector<double> phi[2];

  LayerEquation(double ratio, double poisson)
      : t(gauss_rule(12 + static_cast<int>(2 * ratio))), z(gauss_rule(60 + static_cast<int>(20 * ratio))) {
    const std::size_t n = t.at.size();
    std::vector<double> system(n * n, 0.0), cosine(n);
    phi[0].assign(n, 1.0);
    for (const double each : t.at) phi[1].push_back(each * each);
    for (std::size_t q = 0; q < z.at.size(); ++q) {
      at.push_back(kLargestZ * z.at[q] * ratio);
      weight.push_back(2 / kPi * ratio * kLargestZ * z.weight[q] * missing_of_layer(kLargestZ * z.at[q], poisson));
      for (std::size_t i = 0; i < n; ++i) cosine[i] = std::cos(at[q] * t.at[i]);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) system[i * n + j] -= weight[q] * cosine[i] * cosine[j] * t.weight[j];
    }
    for (std::size_t i = 0; i < n; ++i) system[i * n + i] += 1.0;
    // Gaussian elimination without pivoting; the kernel is a contraction, so no pivot is small.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) {
        const double share = system[j * n + i] / system[i * n + i];
        for (std::size_t c = i; c < n; ++c) system[j * n + c] -= share * system[i * n + c];
        for (std::vector<double>& each : phi) each[j] -= share * each[i];
      }
    for (std::vector<double>& each : phi)
      for (std::size_t i = n; i-- > 0;) {
        for (std::size_t c = i + 1; c < n; ++c) each[i] -= system[i * n + c] * each[c];
        each[i] /= system[i * n + i];
      }
  }
  double sum(std::size_t side) const {
    double out = 0.0;
    for (std::size_t i = 0; i < t.at.size(); ++i) out += t.weight[i] * phi[side][i];
    return out;
  }
  double pressure(std::size_t side, std::size_t q) const {  // A(x) at the q-th x
    double out = 0.0;
    for (std::size_t i = 0; i < t.at.size(); ++i) out += t.weight[i] * phi[side][i] * std::cos(at[q] * t.at[i]);
    return out;
  }
  double at_edge(std::size_t side) const {  // phi(1)
    double out = 1.0;
    for (std::size_t q = 0; q < at.size(); ++q) out += weight[q] * std::cos(at[q]) * pressure(side, q);
    return out;
  }
};

}  // namespace

BondedLayer::BondedLayer(double radius_over_thickness, double poisson) {
  const double ratio = std::min(radius_over_thickness, kThinnest);
  if (!(ratio > 0)) return;
  const LayerEquation equation(ratio, poisson);
  factor_ = equation.sum(0);
  at_ = equation.at;
  for (std::size_t q = 0; q < at_.size(); ++q) weight_.push_back(equation.weight[q] * equation.pressure(0, q));
}

LayerPress sphere_on_layer(double radius_over_thickness, double poisson) {
  const double ratio = radius_over_thickness;
  const LayerEquation equation(ratio, poisson);
  const double depth = ratio * ratio * equation.at_edge(1) / equation.at_edge(0), factor = equation.sum(0);
  return {depth, 2 * ratio * (depth * factor - ratio * ratio * equation.sum(1)), factor};
}

double BondedLayer::surface(double radii) const {
  if (radii <= 1.0) return 1.0;
  static const GaussRule turn = gauss_rule(24);
  const double end = std::asin(1 / radii);
  double u = 2 / kPi * end;
  for (std::size_t q = 0; q < at_.size(); ++q) {
    double direct = 0.0;  // integral of phi - 1
    for (std::size_t i = 0; i < turn.at.size(); ++i)
      direct += end * turn.weight[i] * std::cos(at_[q] * radii * std::sin(end * turn.at[i]));
    u += weight_[q] * (2 / kPi * direct - std::cyl_bessel_j(0.0, at_[q] * radii));
  }
  return u;
}

namespace {

// F = pi a^2 (M d / h) (1 - 2 I1(y) / (y I0(y))), y = a / l, over 2 E* a d; x = a / h.
double thin_layer_factor(double x, double poisson) {
  const double per_modulus = kPi * x * (1 - poisson) / 4;                 // pi a^2 / h * G / (2 E* a)
  const double y2 = 3 * x * x * (1 - 2 * poisson) / (2 * (1 - poisson));  // (a / l)^2
  if (y2 < 1e-4) return per_modulus * 3 * x * x * (1 - y2 / 6) / 8;  // M y^2 / 8 = 3 G x^2 / 8: it cannot be compressed
  const double y = std::sqrt(y2);
  const double ratio = y < 500 ? std::cyl_bessel_i(1.0, y) / std::cyl_bessel_i(0.0, y) : 1 - 0.5 / y;
  return per_modulus * 2 * (1 - poisson) / (1 - 2 * poisson) * (1 - 2 * ratio / y);
}

}  // namespace

double bonded_layer_factor(double radius_over_thickness, double poisson) {
  if (radius_over_thickness <= kThin) return BondedLayer(radius_over_thickness, poisson).factor();
  const double rim = BondedLayer(kThin, poisson).factor() / thin_layer_factor(kThin, poisson) - 1;
  return thin_layer_factor(radius_over_thickness, poisson) * (1 + rim * kThin / radius_over_thickness);
}

}  // namespace pliant
