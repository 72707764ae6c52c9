#include "lab/study/scale/power_law.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "runtime/assert.h"

namespace pliant {
namespace {

// 97.5 % quantiles of Student's t, by degrees of freedom from 1.
constexpr std::array kStudent{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
constexpr std::size_t kLeastFitted = 5;

// A polynomial in x - middle.
struct Fit {
  double middle = 0.0;
  Eigen::VectorXd coefficient;  // ascending
  double within = 0.0;          // half width of the 95 % interval of the last coefficient; may be infinite
};
Fit least_squares(const std::vector<double>& x, const std::vector<double>& y, Eigen::Index coefficients) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Fit fit;
  for (const double each : x) fit.middle += each / static_cast<double>(n);
  Eigen::MatrixXd A(n, coefficients);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    for (Eigen::Index k = 0; k < coefficients; ++k) A(i, k) = std::pow(x[at] - fit.middle, k);
    b[i] = y[at];
  }
  const Eigen::MatrixXd covariance = (A.transpose() * A).inverse();
  fit.coefficient = covariance * (A.transpose() * b);
  fit.within = std::numeric_limits<double>::infinity();
  if (n == coefficients) return fit;
  const auto spare = static_cast<std::size_t>(n - coefficients);
  const double off = (A * fit.coefficient - b).squaredNorm() / static_cast<double>(spare);
  fit.within =
      kStudent[std::min(kStudent.size(), spare) - 1] * std::sqrt(off * covariance(coefficients - 1, coefficients - 1));
  return fit;
}

}  // namespace

double PowerLaw::at(double size) const {
  return factor * std::pow(size, power);
}

std::size_t GrowthCurve::last() const {
  std::size_t i = cost.size();
  while (i > 1 && std::isnan(cost[i - 1])) --i;
  return i - 1;
}

PowerLaw fit_power(const std::vector<double>& all_sizes, const std::vector<double>& all_costs) {
  ASSERT(all_sizes.size() == all_costs.size());
  std::vector<double> x, y;  // logarithms
  for (std::size_t i = 0; i < all_sizes.size(); ++i)
    if (!std::isnan(all_costs[i])) {
      x.push_back(std::log(all_sizes[i]));
      y.push_back(std::log(all_costs[i]));
    }
  ASSERT(x.size() >= 2);
  const std::size_t used = std::min(x.size(), std::max(kLeastFitted, (x.size() + 1) / 2));
  x.erase(x.begin(), x.end() - static_cast<std::ptrdiff_t>(used));
  y.erase(y.begin(), y.end() - static_cast<std::ptrdiff_t>(used));
  PowerLaw law;
  law.from = std::exp(x.front());
  const Fit line = least_squares(x, y, 2);
  law.power = line.coefficient[1];
  law.factor = std::exp(line.coefficient[0] - law.power * line.middle);
  law.within = line.within;
  law.power_at_end = law.power;
  law.curvature_within = std::numeric_limits<double>::infinity();
  if (used < 3) return law;
  const Fit parabola = least_squares(x, y, 3);
  law.curvature = 2 * parabola.coefficient[2];
  law.curvature_within = 2 * parabola.within;
  law.power_at_end = parabola.coefficient[1] + law.curvature * (x.back() - parabola.middle);
  return law;
}

std::string words_of(const PowerLaw& law) {
  if (!law.straight()) return fmt::format("{:.2f}, at the end {:.2f}", law.power, law.power_at_end);
  return std::isfinite(law.within) ? fmt::format("{:.2f} \u00b1 {:.2f}", law.power, law.within)
                                   : fmt::format("{:.2f}", law.power);
}

}  // namespace pliant
