#include "plot/ticks.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr std::size_t kMostTickValues = 100;
constexpr double kRounding = 1e-9;   // [1]
constexpr double kNothing = 1e-300;  // smaller steps count as zero, in any unit

}  // namespace

double tick_step(double high, int most) {
  if (!(high > kNothing) || !std::isfinite(high)) return 1.0;
  double step = std::pow(10.0, std::floor(std::log10(high / most)));
  for (double factor : {1.0, 2.0, 5.0, 10.0})
    if (high / (step * factor) <= most * (1 + 1e-9)) return step * factor;
  return step * 10.0;
}

std::vector<double> tick_values(double low, double high, double step) {
  std::vector<double> ticks;
  const double first = std::ceil(low / step - 1e-9), end = high + 1e-9 * step;
  for (std::size_t i = 0; i < kMostTickValues; ++i) {
    const double value = (first + static_cast<double>(i)) * step + 0.0;  // avoids -0
    if (!(value <= end) || (!ticks.empty() && !(value > ticks.back()))) break;
    ticks.push_back(value);
  }
  return ticks;
}

bool is_flat(double least, double most) {
  return !(most - least > std::max(kRounding * std::max(std::abs(least), std::abs(most)), kNothing));
}

}  // namespace pliant
