#include "systems/soft/linear/conjugate_gradient.h"

#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

// In four lanes, so that the order of additions is machine-independent.
double dot_of(const std::vector<double>& a, const std::vector<double>& b) {
  double lane[4] = {};
  for (std::size_t i = 0; i < a.size(); i += 4)
    for (std::size_t l = 0; l < 4; ++l) lane[l] += a[i + l] * b[i + l];
  return (lane[0] + lane[1]) + lane[2];  // the fourth is 0
}

}  // namespace

void ConjugateGradient::analyse(const BlockMatrix& a) {
  pattern_ = half_pattern(a);
  coarse_.analyse(pattern_);
  for (auto* v : {&work_.b, &work_.x, &work_.r, &work_.z, &work_.p, &work_.q}) v->assign(4 * a.size, 0.0);
  for (auto* v : {&work_.r_single, &work_.z_single, &work_.q_single}) v->assign(4 * a.size, 0.0f);
}

bool ConjugateGradient::factorise(const BlockMatrix& a) {
  matrix_.take(pattern_, a);
  single_.take(pattern_, a);
  return incomplete_.factorise(pattern_, matrix_) && coarse_.factorise(pattern_, matrix_, position_);
}

void ConjugateGradient::residual() const {
  multiply(pattern_, matrix_, work_.x.data(), work_.r.data());
  for (std::size_t i = 0; i < work_.r.size(); ++i) work_.r[i] = work_.b[i] - work_.r[i];
}

void ConjugateGradient::precondition() const {
  Work& w = work_;
  for (std::size_t i = 0; i < w.r.size(); ++i) w.r_single[i] = static_cast<float>(w.r[i]);
  incomplete_.apply(pattern_, w.r_single.data(), w.z_single.data());
  multiply(pattern_, single_, w.z_single.data(), w.q_single.data());
  for (std::size_t i = 0; i < w.r.size(); ++i) w.q_single[i] = w.r_single[i] - w.q_single[i];
  coarse_.correct(w.q_single.data(), w.z_single.data());
  for (std::size_t i = 0; i < w.r.size(); ++i) w.z[i] = w.z_single[i];
}

void ConjugateGradient::solve(const Vector& b, Vector& x) const {
  Work& w = work_;
  for (std::uint32_t i = 0; i < pattern_.size(); ++i)
    for (std::uint32_t d = 0; d < 3; ++d) {
      w.b[4 * i + d] = b[3 * pattern_.old_of_new[i] + d];
      w.x[4 * i + d] = x[3 * pattern_.old_of_new[i] + d];
    }
  residual();
  coarse_.correct(w.r.data(), w.x.data());  // required by the second level: P^T r = 0 from here on
  residual();
  precondition();
  w.p = w.z;
  double rz = dot_of(w.r, w.z);
  for (iterations_ = 0; iterations_ < kMostIterations; ++iterations_) {
    // z approximates the error, since the preconditioner approximates A^-1.
    if (!(dot_of(w.z, w.z) > tolerance * tolerance * dot_of(w.x, w.x))) break;
    multiply(pattern_, matrix_, w.p.data(), w.q.data());
    const double step = rz / dot_of(w.p, w.q);
    for (std::size_t i = 0; i < w.x.size(); ++i) w.x[i] += step * w.p[i];
    for (std::size_t i = 0; i < w.r.size(); ++i) w.r[i] -= step * w.q[i];
    precondition();
    const double before = rz;
    rz = dot_of(w.r, w.z);
    for (std::size_t i = 0; i < w.p.size(); ++i) w.p[i] = w.z[i] + rz / before * w.p[i];
  }
  for (std::uint32_t i = 0; i < pattern_.size(); ++i)
    for (std::uint32_t d = 0; d < 3; ++d) x[3 * pattern_.old_of_new[i] + d] = w.x[4 * i + d];
}

void ConjugateGradient::solve_many(Eigen::Ref<Rows> columns) const {
  Vector x;
  int most = 0;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    x.setZero(columns.rows());
    solve(columns.col(c), x);
    columns.col(c) = x;
    most = std::max(most, iterations_);
  }
  iterations_ = most;
}

std::unique_ptr<LinearSolver> make_conjugate_gradient(std::uint32_t) {
  return std::make_unique<ConjugateGradient>();
}

}  // namespace pliant
