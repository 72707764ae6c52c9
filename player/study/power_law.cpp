#include "player/study/power_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "runtime/assert.h"

namespace pliant {
namespace {

// 97.5 % quantiles of Student's t, by degrees of freedom from 1.
constexpr std::array kStudent{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};

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
  std::vector<double> size, cost;
  for (std::size_t i = 0; i < all_sizes.size(); ++i)
    if (!std::isnan(all_costs[i])) {
      size.push_back(all_sizes[i]);
      cost.push_back(all_costs[i]);
    }
  ASSERT(size.size() >= 2);
  const auto n = static_cast<double>(size.size());
  double mx = 0, my = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < size.size(); ++i) mx += std::log(size[i]) / n, my += std::log(cost[i]) / n;
  for (std::size_t i = 0; i < size.size(); ++i) {
    const double x = std::log(size[i]) - mx;
    sxx += x * x;
    sxy += x * (std::log(cost[i]) - my);
  }
  PowerLaw law;
  law.power = sxy / sxx;
  law.factor = std::exp(my - law.power * mx);
  law.within = std::numeric_limits<double>::infinity();
  if (size.size() == 2) return law;
  double off = 0;
  for (std::size_t i = 0; i < size.size(); ++i) off += std::pow(std::log(cost[i] / law.at(size[i])), 2);
  law.within = kStudent[std::min(kStudent.size(), size.size() - 2) - 1] * std::sqrt(off / (n - 2) / sxx);
  return law;
}

}  // namespace pliant
