#include "systems/soft/local/smeared_kernel.h"

#include <algorithm>
#include <cmath>

#include "components/bonded_layer.h"

namespace pliant {
namespace {

constexpr double kRootPi = 1.77245385090551603;
constexpr double kDeepestWave = 24.0;  // [1] x H: beyond, 1 - L is below rounding
constexpr int kWaves = 96;             // of the quadrature

// e^-t I_n(t), n 0 or 1, to 1e-13: the power series up to here, then Hankel's asymptotic one.
constexpr double kSeries = 18.0;

double bessel_series(int n, double t) {
  const double q = 0.25 * t * t;
  double term = n == 0 ? 1.0 : 0.5 * t, sum = term;
  for (int k = 1; term > 1e-17 * sum; ++k) sum += term *= q / (k * (k + n));
  return std::exp(-t) * sum;
}

// The series' values as Chebyshev polynomials, interval by interval of length 1: within 1e-14, in a tenth of the time.
class BesselTable {
 public:
  explicit BesselTable(int n) {
    for (int i = 0; i < kIntervals; ++i) {
      double value[kTerms];
      for (int k = 0; k < kTerms; ++k) value[k] = bessel_series(n, i + 0.5 + 0.5 * std::cos(M_PI * (k + 0.5) / kTerms));
      for (int j = 0; j < kTerms; ++j) {
        double sum = 0.0;
        for (int k = 0; k < kTerms; ++k) sum += value[k] * std::cos(M_PI * j * (k + 0.5) / kTerms);
        term_[i][j] = (j == 0 ? 1.0 : 2.0) / kTerms * sum;
      }
    }
  }
  double at(double t) const {  // Clenshaw
    const int i = std::min(static_cast<int>(t), kIntervals - 1);
    const double x = 2.0 * (t - i) - 1.0;
    double b1 = 0.0, b2 = 0.0;
    for (int j = kTerms - 1; j > 0; --j) {
      const double b = 2.0 * x * b1 - b2 + term_[i][j];
      b2 = b1, b1 = b;
    }
    return x * b1 - b2 + term_[i][0];
  }

 private:
  static constexpr int kIntervals = static_cast<int>(kSeries), kTerms = 12;
  double term_[kIntervals][kTerms];
};

double scaled_bessel(int n, double t) {
  if (t < kSeries) {
    static const BesselTable zero(0), one(1);
    return (n == 0 ? zero : one).at(t);
  }
  double term = 1.0, sum = 1.0;
  for (int k = 1; k < 40; ++k) {
    const double odd = 2.0 * k - 1.0, next = term * -(4.0 * n * n - odd * odd) / (8.0 * k * t);
    if (std::abs(next) >= std::abs(term) || std::abs(next) < 1e-17) break;
    sum += term = next;
  }
  return sum / std::sqrt(2.0 * M_PI * t);
}

// The table: even in s and smooth in sigma^2.
constexpr int kPlaces = 129, kWidths = 161;
constexpr double kPlace = LayerKernel::kFarthest / (kPlaces - 1);
constexpr double kWidth = LayerKernel::kWidest * LayerKernel::kWidest / (kWidths - 1);

constexpr int kPunches = 49;
constexpr double kPunchStep = 0.0625;  // [1] of a / H

struct Waves {
  std::vector<double> at, missing;  // x H; (1 - L) times the rule's weight
  explicit Waves(double poisson) {
    const GaussRule rule = gauss_rule(kWaves);
    for (std::size_t i = 0; i < rule.at.size(); ++i) {
      at.push_back(kDeepestWave * rule.at[i]);
      missing.push_back(kDeepestWave * rule.weight[i] * missing_of_layer(at.back(), poisson));
    }
  }
};

// Cubic Lagrange weights of four places -1, 0, 1, 2 at x in [0, 1].
void cubic_weights(double x, double (&w)[4]) {
  w[0] = -x * (x - 1) * (x - 2) / 6, w[1] = (x + 1) * (x - 1) * (x - 2) / 2;
  w[2] = -(x + 1) * x * (x - 2) / 2, w[3] = (x + 1) * x * (x - 1) / 6;
}

}  // namespace

double h0(double s, double sigma) {
  return kRootPi / (2 * sigma) * scaled_bessel(0, s * s / (8 * sigma * sigma));
}
double h2(double s, double sigma) {
  return kRootPi / (2 * sigma) * scaled_bessel(1, s * s / (8 * sigma * sigma));
}
double h1(double s, double sigma) {
  return s > 0.0 ? -std::expm1(-s * s / (4 * sigma * sigma)) / s : 0.0;
}

double LayerKernel::by_quadrature(double s, double sigma, double thickness, double poisson) {
  const Waves waves(poisson);
  double sum = 0.0;
  for (std::size_t i = 0; i < waves.at.size(); ++i) {
    const double x = waves.at[i] / thickness;
    sum += waves.missing[i] * std::cyl_bessel_j(0.0, x * s) * std::exp(-x * x * sigma * sigma);
  }
  return sum / thickness;
}

LayerKernel::LayerKernel(double poisson) : poisson_(poisson), table_(static_cast<std::size_t>(kPlaces * kWidths), 0.0) {
  const Waves waves(poisson);
  for (int p = 0; p < kPlaces; ++p)
    for (std::size_t i = 0; i < waves.at.size(); ++i) {
      const double part = waves.missing[i] * std::cyl_bessel_j(0.0, waves.at[i] * kPlace * p);
      const double step = std::exp(-waves.at[i] * waves.at[i] * kWidth);
      double falls = part;
      for (int w = 0; w < kWidths; ++w, falls *= step) table_[static_cast<std::size_t>(p * kWidths + w)] += falls;
    }
  for (int i = 0; i < kPunches; ++i) punch_.push_back(std::log(BondedLayer(i * kPunchStep, poisson).factor()));
}

// Of ln kappa, at even distances.
double LayerKernel::punch(double ratio) const {
  const double place = ratio / kPunchStep;
  if (place >= kPunches - 1) return bonded_layer_factor(ratio, poisson_);
  const int p = std::clamp(static_cast<int>(place), 1, kPunches - 3);
  double weight[4], sum = 0.0;
  cubic_weights(place - p, weight);
  for (int i = 0; i < 4; ++i) sum += weight[i] * punch_[static_cast<std::size_t>(p + i - 1)];
  return std::exp(sum);
}

double LayerKernel::below(double s, double sigma, double thickness) const {
  const double place = std::min(s / thickness / kPlace, kPlaces - 1.0);
  const double width = std::min(sigma * sigma / (thickness * thickness) / kWidth, kWidths - 1.0);
  const int p = std::min(static_cast<int>(place), kPlaces - 3), w = std::clamp(static_cast<int>(width), 1, kWidths - 3);
  double of_p[4], of_w[4];
  cubic_weights(place - p, of_p);
  cubic_weights(width - w, of_w);
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    const int row = std::abs(p + i - 1) * kWidths;
    for (int k = 0; k < 4; ++k) sum += of_p[i] * of_w[k] * table_[static_cast<std::size_t>(row + w + k - 1)];
  }
  return sum / thickness;
}

double LayerKernel::share(double radius, double thickness) const {
  const double sigma = kSigmaOfRadius * radius;
  return 1.0 - below(0.0, sigma, thickness) / h0(0.0, sigma);
}

}  // namespace pliant
