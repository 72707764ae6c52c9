// C1 monotone interpolation of values at ascending times (Fritsch and Butland 1984).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pliant {

struct Monotone {
  std::vector<double> time, value;
  std::vector<double> slows;  // [1] scales the slope at each point; empty: 1
  bool smooth = true;         // false: straight between points
  double slope(std::size_t i) const {
    if (i == 0 || i + 1 == time.size()) return 0.0;
    const double before = time[i] - time[i - 1], after = time[i + 1] - time[i];
    const double left = (value[i] - value[i - 1]) / before, right = (value[i + 1] - value[i]) / after;
    if (left * right <= 0.0) return 0.0;
    const double w1 = 2 * after + before, w2 = after + 2 * before;
    return (w1 + w2) / (w1 / left + w2 / right) * (slows.empty() ? 1.0 : slows[i]);
  }
  double at(std::size_t i, double t) const {  // between i and i + 1
    const double h = time[i + 1] - time[i], s = std::clamp((t - time[i]) / h, 0.0, 1.0);
    if (!smooth) return value[i] + s * (value[i + 1] - value[i]);
    const double s2 = s * s, s3 = s2 * s;
    const double out = (2 * s3 - 3 * s2 + 1) * value[i] + (s3 - 2 * s2 + s) * h * slope(i) +
                       (3 * s2 - 2 * s3) * value[i + 1] + (s3 - s2) * h * slope(i + 1);
    return std::clamp(out, std::min(value[i], value[i + 1]), std::max(value[i], value[i + 1]));
  }
};

}  // namespace pliant
