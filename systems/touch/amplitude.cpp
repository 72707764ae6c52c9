#include "systems/touch/amplitude.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pliant {

double solve_amplitudes(std::span<const double> A, std::span<const double> d, std::span<double> alpha) {
  constexpr int kMaxSweeps = 200;
  constexpr double kTolerance = 1e-7;  // [1] of the largest depth: far below what a float field can show
  const std::size_t n = d.size();
  double size = 0.0;
  for (const double depth : d) size = std::max(size, std::abs(depth));
  const auto violation = [&](std::size_t i) {  // d_i - (A alpha)_i
    double r = d[i];
    for (std::size_t j = 0; j < n; ++j) r -= A[i * n + j] * alpha[j];
    return r;
  };
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    double change = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double next = std::max(0.0, alpha[i] + violation(i) / A[i * n + i]);
      change = std::max(change, std::abs(next - alpha[i]));
      alpha[i] = next;
    }
    if (change <= kTolerance * size) break;
  }
  double worst = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    // An indefinite A (rims that add up) could let amplitudes run away: never more than ten times the deepest probe.
    alpha[i] = std::min(alpha[i], 10 * size);
    const double r = violation(i);
    worst = std::max(worst, alpha[i] > 0 ? std::abs(r) : std::max(0.0, r));
  }
  return worst;
}

}  // namespace pliant
