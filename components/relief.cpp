#include "components/relief.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

std::size_t texel(std::int64_t i, std::uint32_t size, bool repeats) {
  const auto n = static_cast<std::int64_t>(size);
  if (!repeats) return static_cast<std::size_t>(std::clamp<std::int64_t>(i, 0, n - 1));
  const std::int64_t m = i % n;
  return static_cast<std::size_t>(m < 0 ? m + n : m);
}

// Weights of three neighbours about the nearest texel's centre, and their slopes; t in [-1/2, 1/2].
struct Spline {
  std::array<double, 3> weight, slope;
};
Spline quadratic(double t) {
  return {{0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)}, {t - 0.5, -2 * t, t + 0.5}};
}

}  // namespace

HeightMap::Sample HeightMap::at(dvec2 uv) const {
  // Beyond this no texel is exact; far coordinates are the file's fault, not a fault of the tick.
  constexpr double kFar = 1e9;
  const double x = std::clamp(uv.x * width - 0.5, -kFar, kFar), y = std::clamp(uv.y * height - 0.5, -kFar, kFar);
  const double column = std::floor(x + 0.5), row = std::floor(y + 0.5);
  const Spline across = quadratic(x - column), along = quadratic(y - row);
  Sample out;
  for (int j = 0; j < 3; ++j) {
    const std::size_t r = texel(static_cast<std::int64_t>(row) + j - 1, height, repeats_v) * width;
    double value = 0.0, slope = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double c = coefficient[r + texel(static_cast<std::int64_t>(column) + i - 1, width, repeats_u)];
      value += across.weight[static_cast<std::size_t>(i)] * c;
      slope += across.slope[static_cast<std::size_t>(i)] * c;
    }
    out.height += along.weight[static_cast<std::size_t>(j)] * value;
    out.slope.x += along.weight[static_cast<std::size_t>(j)] * slope;
    out.slope.y += along.slope[static_cast<std::size_t>(j)] * value;
  }
  out.slope *= dvec2(width, height);
  return out;
}

}  // namespace pliant
