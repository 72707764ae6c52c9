#include "systems/touch/model/amplitude.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace pliant {
namespace {

constexpr int kMaxSweeps = 100;
constexpr double kTolerance = 1e-7;  // [1] of the largest depth: far below the resolution of a float field
constexpr std::size_t kMost = 64;    // contacts: the working memory is on the stack

// The non-zero entries of each row of A: distant dents do not overlap.
struct AmplitudeRows {
  std::array<std::uint8_t, kMost * kMost> column;
  std::array<std::size_t, kMost + 1> first;

  AmplitudeRows(std::span<const double> A, std::size_t n) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < n; ++i) {
      first[i] = count;
      for (std::size_t j = 0; j < n; ++j)
        if (A[i * n + j] != 0.0) column[count++] = static_cast<std::uint8_t>(j);
    }
    first[n] = count;
  }
};

// Residual of one row: depth minus field at contact i. [m]
double shortfall(std::span<const double> A, const AmplitudeRows& rows, std::span<const double> d,
                 std::span<const double> alpha, std::size_t i) {
  double r = d[i];
  for (std::size_t k = rows.first[i]; k < rows.first[i + 1]; ++k)
    r -= A[i * d.size() + rows.column[k]] * alpha[rows.column[k]];
  return r;
}

double worst_violation(std::span<const double> A, const AmplitudeRows& rows, std::span<const double> d,
                       std::span<const double> alpha) {
  double worst = 0.0;
  for (std::size_t i = 0; i < d.size(); ++i) {
    const double r = shortfall(A, rows, d, alpha, i);
    worst = std::max({worst, alpha[i] > 0 ? std::abs(r) : r, -alpha[i]});
  }
  return worst;
}

// Sweeps converge slowly where probes almost coincide. Solves for the pressing contacts directly (Gauss with partial
// pivoting) and keeps the better of both results.
void polish(std::span<const double> A, const AmplitudeRows& rows, std::span<const double> d, std::span<double> alpha) {
  const std::size_t n = d.size();
  std::array<std::size_t, kMost> pressing;
  std::size_t m = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (alpha[i] > 0) pressing[m++] = i;
  std::array<double, kMost * kMost> M;
  std::array<double, kMost> x;
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < m; ++j) M[i * m + j] = A[pressing[i] * n + pressing[j]];
    x[i] = d[pressing[i]];
  }
  for (std::size_t k = 0; k < m; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < m; ++i)
      if (std::abs(M[i * m + k]) > std::abs(M[pivot * m + k])) pivot = i;
    if (std::abs(M[pivot * m + k]) < 1e-9) return;  // coincident probes: any split of the amplitude is valid
    for (std::size_t j = 0; j < m; ++j) std::swap(M[k * m + j], M[pivot * m + j]);
    std::swap(x[k], x[pivot]);
    for (std::size_t i = k + 1; i < m; ++i) {
      const double f = M[i * m + k] / M[k * m + k];
      for (std::size_t j = k; j < m; ++j) M[i * m + j] -= f * M[k * m + j];
      x[i] -= f * x[k];
    }
  }
  for (std::size_t k = m; k-- > 0;) {
    for (std::size_t j = k + 1; j < m; ++j) x[k] -= M[k * m + j] * x[j];
    x[k] /= M[k * m + k];
  }
  std::array<double, kMost> candidate{};
  for (std::size_t i = 0; i < m; ++i) candidate[pressing[i]] = x[i];
  const std::span<const double> better(candidate.data(), n);
  if (worst_violation(A, rows, d, better) < worst_violation(A, rows, d, alpha))
    std::copy(better.begin(), better.end(), alpha.begin());
}

}  // namespace

double solve_amplitudes(std::span<const double> A, std::span<const double> d, std::span<double> alpha) {
  const std::size_t n = d.size();
  const AmplitudeRows rows(A, n);
  double size = 0.0;
  for (const double depth : d) size = std::max(size, std::abs(depth));
  bool converged = false;
  for (int sweep = 0; sweep < kMaxSweeps && !converged; ++sweep) {
    double change = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double next = std::max(0.0, alpha[i] + shortfall(A, rows, d, alpha, i) / A[i * n + i]);
      change = std::max(change, std::abs(next - alpha[i]));
      alpha[i] = next;
    }
    converged = change <= kTolerance * size;
  }
  if (!converged) polish(A, rows, d, alpha);
  // An indefinite A (rims that add up) could make amplitudes diverge: they are limited to ten times the deepest probe.
  for (double& a : alpha) a = std::min(a, 10 * size);
  return worst_violation(A, rows, d, alpha);
}

}  // namespace pliant
