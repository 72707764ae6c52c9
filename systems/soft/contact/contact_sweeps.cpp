#include "systems/soft/contact/contact_sweeps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/soft/linear/add_three.h"

namespace pliant {
namespace {

// A contact with a diagonal smaller than this share of the largest one cannot be pushed; it is skipped.
constexpr double kImmovable = 1e-14;
constexpr double kBreaks = 0.99;      // [1] of a patch's load on slipping contacts: it breaks loose
constexpr double kElasticSlip = 2.0;  // [1] of the displacement of one contact by the static limit of its friction
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN(), kSingular = HUGE_VAL;  // first of an inverse

double length2(double x, double y) {
  return std::sqrt(x * x + y * y);
}

// Projects (x, y) radially onto the disc.
void clamp_to_disc(double& x, double& y, double radius) {
  const double l = length2(x, y);
  if (l <= radius) return;
  const double s = l > 0.0 ? radius / l : 0.0;
  x *= s, y *= s;
}

// One contact with all others fixed: u = w lambda + c.
struct LocalSolve {
  const dmat3& w;  // symmetric
  dmat3& inverse;  // of w, once it is known
  dvec3 c;         // [m/s]
  double mu;       // [1]
  dvec3 lambda;    // [N s] in: guess; out: solution

  bool stick() {
    if (std::isnan(inverse[0][0])) {
      inverse[0][0] = kSingular;
      if (glm::determinant(w) > 1e-12 * w[0][0] * w[1][1] * w[2][2]) inverse = glm::inverse(w);
    }
    if (inverse[0][0] == kSingular) return false;
    const dvec3 held = -(inverse * c);
    if (!(held.x > 0.0) || length2(held.y, held.z) > mu * held.x) return false;
    lambda = held;
    return true;
  }
  // methods.md 2.5, a few iterations: the normal impulse that stops the approach, then a friction step against the
  // slip, scaled back to the cone. It stops when Coulomb's law holds; the next sweep reduces the remainder.
  void slide() {
    const double trace = w[1][1] + w[2][2];
    const double step = trace > 0.0 ? 2.0 / trace : 0.0;
    for (int k = 0; k < 4; ++k) {
      lambda.x = std::max(0.0, -(c.x + w[0][1] * lambda.y + w[0][2] * lambda.z) / w[0][0]);
      const dvec3 u = w * lambda + c;
      lambda.y -= step * u.y;
      lambda.z -= step * u.z;
      clamp_to_disc(lambda.y, lambda.z, mu * lambda.x);
    }
  }
};

}  // namespace

ContactSweeps::ContactSweeps(ContactProblem& problem)
    : p_(problem),
      W_(problem.shared ? *problem.shared : problem.W),
      lever_(problem.lever),
      stride_(W_.outerStride()),
      turned_(!problem.own.empty()) {
  double largest = 0.0;
  for (int i = 0; i < p_.count; ++i) {
    p_.blocks[i] = read_block(i);
    for (int k = 0; k < 3; ++k) largest = std::max(largest, p_.blocks[i][k][k]);
  }
  for (int i = 0; i < p_.count; ++i) {
    if (!(p_.blocks[i][0][0] > kImmovable * largest)) p_.blocks[i] = dmat3(0.0);
    p_.inverses[i][0][0] = kUnknown;
  }
}

dmat3 ContactSweeps::read_block(int i) const {
  const double* w = nullptr;
  std::ptrdiff_t stride = stride_;
  if (p_.sparse.first.empty()) {
    w = W_.data() + 3 * i * stride_ + 3 * i;
  } else {
    const auto end = p_.sparse.runs.begin() + p_.sparse.first[i + 1];
    const auto run = std::find_if(p_.sparse.runs.begin() + p_.sparse.first[i], end,
                                  [&](const auto& r) { return r.row <= 3 * i && 3 * i < r.row + r.rows; });
    if (run == end) return dmat3(0.0);
    w = p_.sparse.values.data() + run->at + static_cast<std::size_t>(3 * i - run->row);
    stride = run->rows;
  }
  dmat3 block;
  for (int k = 0; k < 3; ++k) block[k] = dvec3(w[k * stride], w[k * stride + 1], w[k * stride + 2]);
  if (lever_)
    for (int c = 0; c < 6; ++c) {
      const dvec3 l = lever_column(i, c);
      block += glm::outerProduct(l, l);
    }
  return turned_ ? glm::transpose(p_.own[i]) * block * p_.own[i] : block;
}

// Updating the whole u costs the same as recomputing each contact's three rows (W is symmetric). It vectorises without
// reordering a sum, and unchanged contacts cost nothing.
void ContactSweeps::add_columns(int i, dvec3 d, double* out) const {
  if (p_.sparse.first.empty()) {
    add_three(out, W_.data() + 3 * i * stride_, stride_, 3 * p_.count, d.x, d.y, d.z);
    return;
  }
  for (int r = p_.sparse.first[i]; r < p_.sparse.first[i + 1]; ++r) {
    const ContactColumns::Run& run = p_.sparse.runs[r];
    add_three(out + run.row, p_.sparse.values.data() + run.at, run.rows, run.rows, d.x, d.y, d.z);
  }
}

dvec3 ContactSweeps::levered(int i) const {
  dvec3 u = three(&p_.velocity[3 * i]);
  for (int c = 0; c < 6; ++c) u += lever_column(i, c) * moved_[static_cast<std::size_t>(c)];
  return u;
}

void ContactSweeps::add_to_lever(int i, dvec3 impulse) {
  for (int c = 0; c < 6; ++c) moved_[static_cast<std::size_t>(c)] += dot(lever_column(i, c), impulse);
}

void ContactSweeps::finish() {
  for (int i = 0; lever_ && i < p_.count; ++i) {
    const dvec3 u = levered(i);
    for (int k = 0; k < 3; ++k) p_.velocity[3 * i + k] = u[k];
  }
  moved_.fill(0.0);
}

void ContactSweeps::refresh_velocity() {
  double* const u = p_.velocity.data();
  std::copy_n(p_.bias.data(), 3 * p_.count, u);
  moved_.fill(0.0);
  for (int i = 0; i < p_.count; ++i) {
    const dvec3 l = three(&p_.impulse[3 * i]);
    if (l == dvec3(0.0)) continue;
    add_columns(i, l, u);
    if (lever_) add_to_lever(i, l);
  }
}

void ContactSweeps::start() {
  for (int i = 0; i < p_.count; ++i) {
    double* const l = &p_.impulse[3 * i];
    const bool good = (held(i) || impulse(i).x > 0.0) && std::isfinite(l[0] + l[1] + l[2]) && movable(i);
    if (!good) l[0] = l[1] = l[2] = 0.0;
  }
  refresh_velocity();
}

void ContactSweeps::project() {
  for (int i = 0; i < p_.count; ++i) {
    dvec3 l = impulse(i);
    if (held(i))
      l = dvec3(holds(i, 0) ? bounded(i, l.x) : 0.0, holds(i, 1) ? l.y : 0.0, holds(i, 2) ? l.z : 0.0);
    else if (l.x > 0.0)
      clamp_to_disc(l.y, l.z, mu(i) * l.x);
    else
      l = dvec3(0.0);
    set_impulse(i, l);
  }
}

double ContactSweeps::fastest() const {
  double speed = 1e-9;
  for (int i = 0; i < p_.count; ++i) {
    const dvec3 u = to_own(i, &p_.bias[3 * i]);
    for (int k = 0; k < 3; ++k)
      if (holds(i, k)) speed = std::max(speed, std::abs(u[k]));
    if (!held(i) && u.x < 0.0) speed = std::max({speed, -u.x, std::abs(u.y), std::abs(u.z)});
  }
  return speed;
}

int ContactSweeps::begin_slips(double slowest) {
  const auto slips = [&](int i) {
    const dvec3 u = velocity(i), l = impulse(i);
    return !held(i) && l.x > 0.0 && length2(u.y, u.z) > slowest &&
           length2(l.y, l.z) >= (1.0 - 1e-9) * p_.mu_static[i] * l.x;
  };
  const bool patches = !p_.patch.empty();
  const auto passes_on = [&](int i) {
    const dmat3& w = block(i);
    return p_.slipped[i] >= kElasticSlip * 0.5 * (w[1][1] + w[2][2]) * p_.mu_static[i] * impulse(i).x;
  };
  if (patches) {
    std::fill_n(p_.patch_load.begin(), p_.count, dvec2(0.0));
    for (int i = 0; i < p_.count; ++i) {
      const double load = impulse(i).x;
      p_.patch_load[p_.patch[i]] += dvec2(load, p_.sliding[i] || (slips(i) && passes_on(i)) ? load : 0.0);
    }
  }
  int begun = 0;
  for (int i = 0; i < p_.count; ++i) {
    if (p_.sliding[i] || !slips(i)) continue;
    if (patches && !p_.loose[i]) {
      const dvec2 load = p_.patch_load[p_.patch[i]];
      if (load.y < kBreaks * load.x) continue;
    }
    p_.sliding[i] = 1;
    begun += p_.mu_sliding[i] < p_.mu_static[i];
  }
  return begun;
}

void ContactSweeps::end_slips() {
  for (int i = 0; i < p_.count; ++i) {
    const dvec3 l = impulse(i);
    if (l.x <= 0.0 || length2(l.y, l.z) < (1.0 - 1e-6) * mu(i) * l.x) p_.sliding[i] = 0;
  }
}

void ContactSweeps::sweep() {
  if (lever_)
    for (int i = 0; i < p_.count; ++i) relax<true>(i);
  else
    for (int i = 0; i < p_.count; ++i) relax<false>(i);
}

dvec3 ContactSweeps::hold(int i, dvec3 c) {
  dmat3 w = block(i);
  for (int k = 0; k < 3; ++k) {
    if (holds(i, k)) continue;
    w[0][k] = w[1][k] = w[2][k] = 0.0, w[k] = dvec3(0.0);
    w[k][k] = 1.0, c[k] = 0.0;
  }
  dmat3& inverse = p_.inverses[i];
  if (std::isnan(inverse[0][0])) inverse = glm::inverse(w);
  const dvec3 found = -(inverse * c);
  return {bounded(i, found.x), found.y, found.z};
}

// Twice: without a lever it stays short.
template <bool kLever>
void ContactSweeps::relax(int i) {
  double* const l = &p_.impulse[3 * i];
  const dvec3 before = three(l), old = to_own(i, l);
  const dvec3 plain = kLever ? levered(i) : three(&p_.velocity[3 * i]), u = to_own(i, &plain.x);
  const bool joint = held(i) != 0;
  if (!joint && old.x == 0.0 && u.x >= 0.0) return;
  if (!movable(i)) return;
  const dmat3& w = p_.blocks[i];
  LocalSolve local{w, p_.inverses[i], u - w * old, mu(i), old};
  if (joint)
    local.lambda = hold(i, local.c);
  else if (local.c.x >= 0.0)
    local.lambda = dvec3(0.0);
  else if (!local.stick())
    local.slide();
  const dvec3 after = from_own(i, local.lambda), d = after - before;
  if (d == dvec3(0.0)) return;
  for (int k = 0; k < 3; ++k) l[k] = after[k];
  add_columns(i, d, p_.velocity.data());
  if constexpr (kLever) add_to_lever(i, d);
}

double ContactSweeps::residual_of(int i) const {
  const dvec3 u = velocity(i), l = impulse(i);
  if (held(i)) {
    double worst = 0.0;
    for (int k = 0; k < 3; ++k)
      if (holds(i, k) && (k > 0 || !at_bound(i, l.x, u.x))) worst = std::max(worst, std::abs(u[k]));
    if (holds(i, 0) && at_bound(i, l.x, u.x)) {
      const double w = block(i)[0][0];
      worst = std::max(worst, w * std::abs(l.x - bounded(i, l.x - u.x / w)));
    }
    return worst;
  }
  const dmat3& w = block(i);
  const double wn = w[0][0], wt = 0.5 * (w[1][1] + w[2][2]);
  double y = wt * l.y - u.y, z = wt * l.z - u.z;
  clamp_to_disc(y, z, mu(i) * wt * l.x);
  return std::max(std::abs(std::min(wn * l.x, u.x)), length2(wt * l.y - y, wt * l.z - z));
}

double ContactSweeps::residual() const {
  double worst = 0.0;
  for (int i = 0; i < p_.count; ++i)
    if (movable(i)) worst = std::max(worst, residual_of(i));
  return worst;
}

}  // namespace pliant
