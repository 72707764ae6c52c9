#include "content/tets/step_cost.h"

#include <time.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace pliant {
namespace {

constexpr std::size_t kSize = 192;  // of the matrix that is factorised
constexpr int kRuns = 8;
constexpr double kReference = 0.30;  // [ms] its time on the reference machine

double thread_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Cholesky factorisation, column by column, like the panels of block_cholesky.
double factorise(std::vector<double>& a) {
  for (std::size_t j = 0; j < kSize; ++j) {
    double* const column = &a[j * kSize];
    const double pivot = 1.0 / column[j];
    for (std::size_t k = j + 1; k < kSize; ++k) {
      double* const other = &a[k * kSize];
      const double factor = column[k] * pivot;
      for (std::size_t i = k; i < kSize; ++i) other[i] -= factor * column[i];
    }
  }
  return a.back();
}

double measure() {
  std::vector<double> matrix(kSize * kSize, 0.5);
  for (std::size_t i = 0; i < kSize; ++i) matrix[i * kSize + i] = 2.0 * kSize;
  double least = std::numeric_limits<double>::infinity(), sum = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<double> a = matrix;
    const double begin = thread_ms();
    sum += factorise(a);
    least = std::min(least, thread_ms() - begin);
  }
  return sum > 0.0 ? std::max(least, 1e-3) / kReference : 1.0;  // using the sum keeps the compiler from removing the
                                                                // computation
}

}  // namespace

double machine_slowness() {
  static const double slowness = measure();
  return slowness;
}

double step_ms(std::size_t tetrahedra, double slowness) {
  const double n = static_cast<double>(tetrahedra);
  return slowness * (kStepBase + kStepSquare * n * n);
}

}  // namespace pliant
