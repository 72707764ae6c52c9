#include "components/monotone_cubic.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// Share of the first interval's mean slope that the slope at 0 has at least: a table that stiffens has a stiffness.
constexpr double kLeastSlope = 0.25;

// [N/m] at each row.
std::array<double, ForceTable::kMost> slopes_of(const ForceTable& table) {
  std::array<double, ForceTable::kMost> width{}, mean{}, slope{};
  const std::size_t n = table.count;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    width[i] = table.rows[i + 1][0] - table.rows[i][0];
    mean[i] = (table.rows[i + 1][1] - table.rows[i][1]) / width[i];
  }
  if (n == 2) return {mean[0], mean[0]};
  // Of the parabola through three rows.
  for (std::size_t i = 1; i + 1 < n; ++i)
    slope[i] = mean[i - 1] > 0 && mean[i] > 0
                   ? (width[i] * mean[i - 1] + width[i - 1] * mean[i]) / (width[i - 1] + width[i])
                   : 0.0;
  const auto end = [](double near, double far, double mean_near, double mean_far) {
    return ((2 * near + far) * mean_near - near * mean_far) / (near + far);
  };
  slope[0] = std::clamp(end(width[0], width[1], mean[0], mean[1]), kLeastSlope * mean[0], 3 * mean[0]);
  slope[n - 1] = std::clamp(end(width[n - 2], width[n - 3], mean[n - 2], mean[n - 3]), 0.0, 3 * mean[n - 2]);
  // Monotone inside the circle of radius 3 (section 3).
  for (std::size_t i = 0; i + 1 < n; ++i) {
    if (!(mean[i] > 0)) continue;
    const double a = slope[i] / mean[i], b = slope[i + 1] / mean[i], length = std::hypot(a, b);
    if (length <= 3) continue;
    slope[i] = 3 / length * a * mean[i];
    slope[i + 1] = 3 / length * b * mean[i];
  }
  slope[0] = std::max(slope[0], kLeastSlope * mean[0]);
  return slope;
}

}  // namespace

double stiffness_of(const ForceTable& table) {
  return slopes_of(table)[0];
}

MonotoneCubic monotone_cubic(const ForceTable& table, double stiffness) {
  MonotoneCubic out;
  if (table.count < 2) return out;
  const auto slope = slopes_of(table);
  double integral = 0.0;
  for (std::size_t i = 0; i < table.count; ++i) {
    CubicPiece piece{table.rows[i][0], table.rows[i][1] / stiffness, slope[i] / stiffness, 0.0, 0.0, integral};
    if (i + 1 < table.count) {
      const double w = table.rows[i + 1][0] - piece.at, mean = (table.rows[i + 1][1] / stiffness - piece.value) / w,
                   next = slope[i + 1] / stiffness;
      piece.second = (3 * mean - 2 * piece.slope - next) / w;
      piece.third = (piece.slope + next - 2 * mean) / (w * w);
      integral += w * (piece.value + w * (piece.slope / 2 + w * (piece.second / 3 + w * piece.third / 4)));
    }
    out.add(piece);
  }
  return out;
}

}  // namespace pliant
