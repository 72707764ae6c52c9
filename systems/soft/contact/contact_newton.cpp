#include "systems/soft/contact/contact_newton.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/linear/pivoted_lu.h"
#include "systems/soft/linear/sparse_lu.h"

namespace pliant {
namespace {

constexpr int kSweepsBetween = 10, kMostBetween = 20;  // sweeps before a Newton step; the latter after failures
constexpr int kDense = 240, kMostUnknowns = 900;       // up to the former a dense solver is faster
constexpr double kMostWork = 4e7;                      // [1] multiplications in total: about 5 ms
constexpr int kDrops = 4;                              // number of times that a step is recomputed
constexpr double kTogether = 2.0;                      // [1] contacts reached within this multiple of the first
// [1] of the diagonal. With less at first, rigid bodies with more contacts than degrees of freedom get unbounded
// impulses while an opening contact is assumed closed.
constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-9, kMostDamping = 1e-2;
constexpr double kHarder = 30.0, kEasier = 0.1;  // [1] damping after a failure, after a success
constexpr double kFalls = 0.9;                   // [1] of the residual: a step with less reduction has failed
constexpr double kOnBorder = 1.0 - 1e-9;         // [1] of the cone: beyond it a contact slides

double mean_tangential(const dmat3& w) {
  return 0.5 * (w[1][1] + w[2][2]);
}

}  // namespace

ContactNewton::ContactNewton(ContactSweeps& sweeps, int most)
    : s_(sweeps), m_(sweeps.problem().newton), most_(most), wait_(kSweepsBetween), damping_(kFirstDamping) {
  if (most == 0) return;
  const auto count = static_cast<std::size_t>(s_.problem().count), rows = 3 * count;
  for (std::vector<double>* v : {&m_.right, &m_.column, &m_.impulse, &m_.velocity, &m_.extra})
    if (v->size() < rows) v->resize(rows);
  for (std::vector<int>* v : {&m_.pivots, &m_.contact})
    if (v->size() < rows) v->resize(rows);
  for (std::vector<dvec3>* v : {&m_.way, &m_.test})
    if (v->size() < rows) v->resize(rows);
  if (m_.base.size() < count) m_.base.resize(count);
  if (m_.dropped.size() < count) m_.dropped.resize(count);
}

double ContactNewton::step(double residual, double enough) {
  ContactProblem& p = s_.problem();
  const int rows = 3 * p.count;
  std::copy_n(p.impulse.data(), rows, m_.impulse.data());
  std::copy_n(p.velocity.data(), rows, m_.velocity.data());
  double share = 1.0;
  for (int tries = 0; tries < 2; ++tries) {
    if (tries == 0 && !find_step()) break;
    double now = attempt(share);
    if (now > enough && now >= kFalls * residual) {
      s_.sweep();
      now = s_.residual();
    }
    if (now <= enough || now < kFalls * residual) {
      damping_ = std::max(kEasier * damping_, kLeastDamping);
      wait_ = kSweepsBetween;
      return now;
    }
    share = std::clamp(first_pull(), 1e-3, 0.5);
  }
  std::copy_n(m_.impulse.data(), rows, p.impulse.data());
  std::copy_n(m_.velocity.data(), rows, p.velocity.data());
  damping_ = std::min(kHarder * damping_, kMostDamping);
  wait_ = kMostBetween;
  return residual;
}

double ContactNewton::attempt(double share) {
  ContactProblem& p = s_.problem();
  for (int i = 0; i < p.count; ++i)
    for (int k = 0; k < 3; ++k) {
      const double from = m_.impulse[3 * i + k];
      p.impulse[3 * i + k] = from + share * (m_.base[i][k] - from);
    }
  s_.project();
  s_.refresh_velocity();
  return s_.residual();
}

double ContactNewton::first_pull() const {
  double share = 1.0;
  for (int i = 0; i < s_.problem().count; ++i) {
    const double from = s_.to_own(i, &m_.impulse[3 * i]).x, to = s_.to_own(i, &m_.base[i].x).x;
    if (!s_.held(i) && from > 0.0 && to < 0.0) share = std::min(share, from / (from - to));
  }
  return share;
}

bool ContactNewton::find_step() {
  std::fill_n(m_.dropped.begin(), s_.problem().count, std::uint8_t{0});
  for (int again = 0;; ++again) {
    if (solves_ == most_ || !choose_unknowns()) return false;
    const bool solved = solve_system();
    if (work_ > kMostWork) most_ = solves_;  // no more Newton steps in this solve
    if (!solved) return false;
    ++solves_;
    for (int c = 0; c < unknowns_; ++c)
      if (!std::isfinite(m_.right[c])) return false;
    if (again == kDrops || !drop_pulling()) break;
  }
  for (int c = 0; c < unknowns_; ++c) m_.base[m_.contact[c]] += m_.right[c] * m_.way[c];
  return true;
}

// Unknown c moves the impulse of contact[c] along way[c]; its equation is test[c] . u + extra[c] x_c = right[c]. All in
// W's axes. base: the initial impulses. They are zero for dropped contacts; for sliding ones, friction along z has its
// required magnitude.
bool ContactNewton::choose_unknowns() {
  ContactProblem& p = s_.problem();
  unknowns_ = 0;
  std::copy_n(m_.velocity.data(), 3 * p.count, m_.column.data());
  for (int i = 0; i < p.count; ++i) {
    const dvec3 l = s_.to_own(i, &m_.impulse[3 * i]), u = s_.to_own(i, &m_.velocity[3 * i]);
    dvec3 base = l;
    const auto add = [&](dvec3 way, dvec3 test, double extra, double right) {
      m_.contact[unknowns_] = i;
      m_.way[unknowns_] = s_.from_own(i, way);
      m_.test[unknowns_] = s_.from_own(i, test);
      m_.extra[unknowns_] = extra;
      m_.right[unknowns_++] = right;
    };
    if (s_.held(i) && s_.movable(i)) {
      const bool bound = s_.at_bound(i, l.x, u.x);
      if (bound) base.x = std::copysign(s_.most(i), s_.block(i)[0][0] * l.x - u.x);
      for (int k = bound ? 1 : 0; k < 3; ++k)
        if (s_.holds(i, k)) add(dmat3(1.0)[k], dmat3(1.0)[k], 0.0, 0.0);
    } else if (!s_.movable(i) || l.x <= 0.0 || m_.dropped[i]) {
      base = dvec3(0.0);
    } else {
      const double mu = s_.mu(i), wt = mean_tangential(s_.block(i));
      const dvec2 z = wt * dvec2(l.y, l.z) - dvec2(u.y, u.z);
      const double size = length(z);
      if (size > 0.0 && length(dvec2(l.y, l.z)) >= kOnBorder * mu * l.x) {
        const dvec2 t = z / size, aside(-t.y, t.x);
        const double straightens = std::min(1.0, mu * wt * l.x / size);  // share of the transverse u that rotates z
        const double along = mu * l.x, across = dot(aside, dvec2(l.y, l.z));
        base = dvec3(l.x, along * t + across * aside);
        const dvec3 q(0.0, aside);
        add(dvec3(1.0, mu * t), dvec3(1, 0, 0), 0.0, 0.0);
        if (straightens > 0.0) add(q, straightens * q, wt * (1.0 - straightens), straightens * dot(q, u) - wt * across);
      } else {
        for (int k = 0; k < 3; ++k) add(dmat3(1.0)[k], dmat3(1.0)[k], 0.0, 0.0);
      }
    }
    m_.base[i] = s_.from_own(i, base);
    const dvec3 moved = m_.base[i] - dvec3(m_.impulse[3 * i], m_.impulse[3 * i + 1], m_.impulse[3 * i + 2]);
    if (moved != dvec3(0.0)) s_.add_columns(i, moved, m_.column.data());
  }
  for (int c = 0; c < unknowns_; ++c) {
    const double* const u = &m_.column[3 * m_.contact[c]];
    m_.right[c] -= dot(m_.test[c], dvec3(u[0], u[1], u[2]));
  }
  return unknowns_ > 0 && unknowns_ <= kMostUnknowns;
}

void ContactNewton::fill_system() {
  const auto size = static_cast<std::size_t>(unknowns_);
  if (m_.matrix.size() < size * size) m_.matrix.resize(size * size);
  for (int c = 0; c < unknowns_; ++c) {
    std::fill_n(m_.column.begin(), 3 * s_.problem().count, 0.0);
    s_.add_columns(m_.contact[c], m_.way[c], m_.column.data());
    double* const out = m_.matrix.data() + size * static_cast<std::size_t>(c);
    for (int r = 0; r < unknowns_; ++r) {
      const double* const u = &m_.column[3 * m_.contact[r]];
      out[r] = m_.test[r].x * u[0] + m_.test[r].y * u[1] + m_.test[r].z * u[2];
    }
    out[c] = (out[c] + m_.extra[c]) * (1.0 + damping_);
  }
}

bool ContactNewton::solve_system() {
  if (unknowns_ > kDense) {
    fill_system();
    double work = kMostWork - work_;
    const bool solved = solve_sparse_lu(m_.matrix, unknowns_, m_.right.data(), work);
    work_ += work;
    return solved;
  }
  const double unknowns = unknowns_;
  work_ += unknowns * unknowns * unknowns;
  if (work_ > kMostWork) return false;
  fill_system();
  if (!factorise_lu(m_.matrix.data(), unknowns_, unknowns_, m_.pivots.data())) return false;
  solve_lu(m_.matrix.data(), unknowns_, unknowns_, m_.pivots.data(), m_.right.data());
  return true;
}

bool ContactNewton::drop_pulling() {
  const auto met = [&](int c) {  // [1] of the step: where the contact stops pushing
    const dvec3 way = s_.to_own(m_.contact[c], &m_.way[c].x);
    const double from = s_.to_own(m_.contact[c], &m_.base[m_.contact[c]].x).x, by = m_.right[c] * way.x;
    return !s_.held(m_.contact[c]) && way.x > 0.5 && from + by < 0.0 ? from / -by : 2.0;
  };
  double first = 2.0;
  for (int c = 0; c < unknowns_; ++c) first = std::min(first, met(c));
  if (first > 1.0) return false;
  for (int c = 0; c < unknowns_; ++c)
    if (met(c) <= std::min(1.0, kTogether * first)) m_.dropped[m_.contact[c]] = 1;
  return true;
}

}  // namespace pliant
