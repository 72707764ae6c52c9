#include "lab/fit/least_squares.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr double kDifference = 1e-6;  // [1] of the scale: central differences
constexpr int kMostSteps = 200;
constexpr double kSmall = 1e-12;     // [1] stops at a relative gain below this
constexpr double kFlattest = 1e-12;  // [1] smallest eigenvalue of the scaled normal matrix; below: singular

struct Problem {
  const std::vector<FitParameter>& parameters;
  const Residuals& residuals;
  Eigen::Index count;

  Eigen::Index size() const { return static_cast<Eigen::Index>(parameters.size()); }
  const FitParameter& at(Eigen::Index k) const { return parameters[static_cast<std::size_t>(k)]; }
  double clamped(double value, Eigen::Index k) const { return std::clamp(value, at(k).low, at(k).high); }

  // Jacobian by differences in units of the scales. Evaluates only inside the box: one-sided near a bound.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& p) const {
    Eigen::MatrixXd out(count, size());
    Eigen::VectorXd above(count), below(count), moved = p;
    for (Eigen::Index k = 0; k < size(); ++k) {
      const double step = kDifference * std::max(at(k).scale, std::abs(p[k]));
      const double up = clamped(p[k] + step, k), down = clamped(p[k] - step, k);
      moved[k] = up;
      residuals(moved, above);
      moved[k] = down;
      residuals(moved, below);
      moved[k] = p[k];
      if (up > down)
        out.col(k) = (above - below) * (at(k).scale / (up - down));
      else
        out.col(k).setZero();
    }
    return out;
  }
};

// A parameter at a bound whose step would lead outwards is kept: its row of the normal equations is the identity.
Eigen::VectorXd damped_step(const Problem& problem, const Eigen::VectorXd& p, const Eigen::MatrixXd& J,
                            const Eigen::VectorXd& r, double damping) {
  const Eigen::VectorXd gradient = J.transpose() * r;
  Eigen::MatrixXd normal = J.transpose() * J;
  Eigen::VectorXd right = -gradient;
  for (Eigen::Index k = 0; k < problem.size(); ++k) {
    const bool stuck =
        (p[k] <= problem.at(k).low && gradient[k] > 0) || (p[k] >= problem.at(k).high && gradient[k] < 0);
    if (!stuck) {
      normal(k, k) *= 1 + damping;
      continue;
    }
    normal.row(k).setZero();
    normal.col(k).setZero();
    normal(k, k) = 1.0;
    right[k] = 0.0;
  }
  for (Eigen::Index k = 0; k < problem.size(); ++k)
    if (!(normal(k, k) > 0)) normal(k, k) = 1.0;
  return normal.ldlt().solve(right);
}

// Descends from out.p; returns the Jacobian where it ends.
Eigen::MatrixXd descend(const Problem& problem, LeastSquares& out) {
  const Eigen::Index n = problem.size();
  Eigen::VectorXd r(problem.count), tried(problem.count);
  problem.residuals(out.p, r);
  out.sum = r.squaredNorm();
  double damping = 1e-3, growth = 2.0;
  Eigen::MatrixXd J = problem.jacobian(out.p);
  for (; out.iterations < kMostSteps && !out.converged; ++out.iterations) {
    const Eigen::VectorXd step = damped_step(problem, out.p, J, r, damping);
    Eigen::VectorXd p = out.p;
    for (Eigen::Index k = 0; k < n; ++k) p[k] = problem.clamped(p[k] + step[k] * problem.at(k).scale, k);
    problem.residuals(p, tried);
    const double sum = tried.squaredNorm();
    if (std::isfinite(sum) && sum <= out.sum) {
      double moved = 0.0;
      for (Eigen::Index k = 0; k < n; ++k)
        moved = std::max(moved, std::abs(p[k] - out.p[k]) / std::max(problem.at(k).scale, std::abs(p[k])));
      out.converged = out.sum - sum <= kSmall * out.sum && moved < 1e-7;
      out.p = p;
      out.sum = sum;
      r = tried;
      damping = std::max(damping / 3.0, 1e-15);
      growth = 2.0;
      J = problem.jacobian(out.p);
    } else {
      damping *= growth;
      growth *= 2.0;
      if (damping > 1e12) out.converged = true;  // no step reduces the sum: a minimum to rounding
    }
  }
  return J;
}

// Fills on_bound, covariance and singular at out.p.
void find_covariance(const Problem& problem, const Eigen::MatrixXd& J, LeastSquares& out) {
  const Eigen::Index n = problem.size();
  out.on_bound.assign(static_cast<std::size_t>(n), false);
  std::vector<Eigen::Index> free;
  for (Eigen::Index k = 0; k < n; ++k) {
    const FitParameter& it = problem.at(k);
    const double near = 1e-9 * std::max(it.scale, std::abs(out.p[k]));
    const bool bound = out.p[k] - it.low <= near || it.high - out.p[k] <= near;
    out.on_bound[static_cast<std::size_t>(k)] = bound;
    if (!bound) free.push_back(k);
  }
  out.covariance = Eigen::MatrixXd::Zero(n, n);
  const auto m = static_cast<Eigen::Index>(free.size());
  if (m == 0 || problem.count <= m) return;
  Eigen::MatrixXd normal(m, m);
  Eigen::VectorXd size(m);
  for (Eigen::Index i = 0; i < m; ++i) size[i] = J.col(free[static_cast<std::size_t>(i)]).norm();
  if (!(size.minCoeff() > 0)) {
    out.singular = true;
    return;
  }
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index k = 0; k < m; ++k)
      normal(i, k) =
          J.col(free[static_cast<std::size_t>(i)]).dot(J.col(free[static_cast<std::size_t>(k)])) / (size[i] * size[k]);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(normal);
  out.singular = eigen.eigenvalues().minCoeff() < kFlattest;
  if (out.singular) return;
  const Eigen::MatrixXd inverse =
      eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
  const double variance = out.sum / static_cast<double>(problem.count - m);
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index k = 0; k < m; ++k) {
      const Eigen::Index a = free[static_cast<std::size_t>(i)], b = free[static_cast<std::size_t>(k)];
      out.covariance(a, b) = variance * inverse(i, k) / (size[i] * size[k]) * problem.at(a).scale * problem.at(b).scale;
    }
}

}  // namespace

LeastSquares least_squares(const std::vector<FitParameter>& parameters, Eigen::Index count,
                           const Residuals& residuals) {
  const Problem problem{parameters, residuals, count};
  LeastSquares out;
  out.p.resize(problem.size());
  for (Eigen::Index k = 0; k < problem.size(); ++k) out.p[k] = problem.clamped(problem.at(k).start, k);
  find_covariance(problem, descend(problem, out), out);
  return out;
}

double student_t(double share, double degrees) {
  // The probability within (-t, t) is 1 - I_x(v/2, 1/2), x = v / (v + t^2). The density is integrated and t found by
  // bisection.
  const double scale = std::exp(std::lgamma(0.5 * (degrees + 1)) - std::lgamma(0.5 * degrees)) /
                       std::sqrt(degrees * 3.14159265358979323846);
  const auto within = [&](double t) {
    // Substituting t = sqrt(v) tan(a), the density becomes cos(a)^(v-1), smooth on a finite range.
    const double end = std::atan(t / std::sqrt(degrees));
    constexpr int kParts = 400;
    double sum = 0.0;
    for (int i = 0; i <= kParts; ++i) {
      const double weight = i == 0 || i == kParts ? 1.0 : i % 2 ? 4.0 : 2.0;
      sum += weight * std::pow(std::cos(end * i / kParts), degrees - 1);
    }
    return 2.0 * scale * std::sqrt(degrees) * sum * end / (3.0 * kParts);
  };
  double low = 0.0, high = 1.0;
  while (within(high) < share && high < 1e8) high *= 2.0;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (within(middle) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace pliant
