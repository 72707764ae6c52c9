#include "systems/tool/contact_problem.h"

#include <algorithm>
#include <cmath>

#include "components/math.h"
#include "runtime/assert.h"
#include "runtime/clock.h"
#include "runtime/kernel.h"

namespace pliant {
namespace {

// A diagonal smaller than this share of the largest one cannot be pushed: such contacts are left alone.
constexpr double kImmovable = 1e-14;

// u += [w0 w1 w2] d: three neighbouring columns of W. Keeping u whole costs the same as forming each contact's three
// rows anew (W is symmetric), vectorises without reordering a sum, and contacts that do not change cost nothing.
PLIANT_KERNEL void add_columns(double* __restrict u, const double* __restrict w, std::ptrdiff_t stride, int rows,
                               double d0, double d1, double d2) {
  const double* __restrict w0 = w;
  const double* __restrict w1 = w + stride;
  const double* __restrict w2 = w + 2 * stride;
  for (int i = 0; i < rows; ++i) u[i] += (w0[i] * d0 + w1[i] * d1) + w2[i] * d2;
}

double length2(double x, double y) {
  return std::sqrt(x * x + y * y);
}

// The largest point of the segment from 0 to (x, y) inside the disc.
void clamp_to_disc(double& x, double& y, double radius) {
  const double l = length2(x, y);
  if (l <= radius) return;
  const double s = l > 0.0 ? radius / l : 0.0;
  x *= s, y *= s;
}

// One contact with all others held: u = w lambda + c.
struct Local {
  dmat3 w;       // symmetric
  dvec3 c;       // [m/s]
  double mu;     // [1]
  dvec3 lambda;  // [N s] guess in, answer out

  bool stick() {
    const double det = glm::determinant(w);
    if (!(det > 1e-12 * w[0][0] * w[1][1] * w[2][2])) return false;
    const dvec3 held = -(glm::inverse(w) * c);
    if (!(held.x > 0.0) || length2(held.y, held.z) > mu * held.x) return false;
    lambda = held;
    return true;
  }
  // methods.md 2.5, a few times over: the normal impulse that stops the approach, then a step of friction against the
  // slip, scaled back to the cone. It ends where Coulomb holds; what is left is left to the next sweep.
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

// [m/s] Of the contacts that close without impulses: what is still far away does not say how exact the others must be.
double fastest(const ContactProblem& problem) {
  double speed = 1e-9;
  for (int i = 0; i < problem.count; ++i) {
    const dvec3 u(problem.bias[3 * i], problem.bias[3 * i + 1], problem.bias[3 * i + 2]);
    const dvec3 own = problem.own.empty() ? u : u * problem.own[static_cast<std::size_t>(i)];
    if (own.x < 0.0) speed = std::max({speed, -own.x, std::abs(own.y), std::abs(own.z)});
  }
  return speed;
}

class Sweeper {
 public:
  explicit Sweeper(ContactProblem& problem)
      : p_(problem), rows_(3 * problem.count), stride_(problem.W.outerStride()), turned_(!problem.own.empty()) {
    double largest = 0.0;
    for (int i = 0; i < rows_; ++i) largest = std::max(largest, p_.W(i, i));
    immovable_ = kImmovable * largest;
  }

  // A guess may come from another problem: whatever cannot be is dropped. Then u = W lambda + bias.
  void start() {
    double* u = p_.velocity.data();
    for (int i = 0; i < rows_; ++i) u[i] = p_.bias[i];
    for (int i = 0; i < p_.count; ++i) {
      double* l = &p_.impulse[3 * i];
      const double normal = own(i, l).x;
      const bool good = normal > 0.0 && std::isfinite(l[0] + l[1] + l[2]) && movable(i);
      if (!good) l[0] = l[1] = l[2] = 0.0;
      if (good) add_columns(u, column(i), stride_, rows_, l[0], l[1], l[2]);
    }
  }

  void sweep() {
    for (int i = 0; i < p_.count; ++i) relax(i);
  }

  double residual() const {
    double worst = 0.0;
    for (int i = 0; i < p_.count; ++i)
      if (movable(i)) worst = std::max(worst, residual_of(i));
    return worst;
  }

  // Contacts that have come to the border of the static cone and slip go on with the sliding coefficient. Decided only
  // on settled impulses: on the way there every contact with a small normal impulse seems to slip. How many changed?
  int begin_slips(double slowest) {
    int begun = 0;
    for (int i = 0; i < p_.count; ++i) {
      const dvec3 u = own(i, &p_.velocity[3 * i]), l = own(i, &p_.impulse[3 * i]);
      if (p_.sliding[i] || l.x <= 0.0 || length2(u.y, u.z) <= slowest) continue;
      if (length2(l.y, l.z) < (1.0 - 1e-9) * p_.mu_static[i] * l.x) continue;
      p_.sliding[i] = 1;
      begun += p_.mu_sliding[i] < p_.mu_static[i];
    }
    return begun;
  }
  // Those that slipped and now lie inside the sliding cone hold again.
  void end_slips() {
    for (int i = 0; i < p_.count; ++i) {
      const dvec3 l = own(i, &p_.impulse[3 * i]);
      if (l.x <= 0.0 || length2(l.y, l.z) < (1.0 - 1e-6) * mu(i) * l.x) p_.sliding[i] = 0;
    }
  }

 private:
  double mu(int i) const { return p_.sliding[i] ? p_.mu_sliding[i] : p_.mu_static[i]; }
  const double* column(int i) const { return p_.W.data() + 3 * i * stride_; }
  // What is written in W's axes, in the contact's own.
  dvec3 own(int i, const double* v) const {
    const dvec3 x(v[0], v[1], v[2]);
    return turned_ ? x * p_.own[i] : x;
  }
  dmat3 own_block(int i) const {
    const double* w = column(i) + 3 * i;
    dmat3 block;
    for (int k = 0; k < 3; ++k) block[k] = dvec3(w[k * stride_], w[k * stride_ + 1], w[k * stride_ + 2]);
    return turned_ ? glm::transpose(p_.own[i]) * block * p_.own[i] : block;
  }
  bool movable(int i) const { return p_.W(3 * i, 3 * i) > immovable_; }

  void relax(int i) {
    double* l = &p_.impulse[3 * i];
    const dvec3 u = own(i, &p_.velocity[3 * i]), before(l[0], l[1], l[2]);
    Local local;
    local.lambda = own(i, l);
    if (local.lambda.x == 0.0 && u.x >= 0.0) return;
    if (!movable(i)) return;
    local.w = own_block(i);
    local.c = u - local.w * local.lambda;
    local.mu = mu(i);
    if (local.c.x >= 0.0)
      local.lambda = dvec3(0.0);
    else if (!local.stick())
      local.slide();
    const dvec3 after = turned_ ? p_.own[i] * local.lambda : local.lambda, d = after - before;
    if (d == dvec3(0.0)) return;
    for (int k = 0; k < 3; ++k) l[k] = after[k];
    add_columns(p_.velocity.data(), column(i), stride_, rows_, d.x, d.y, d.z);
  }

  double residual_of(int i) const {
    const dvec3 u = own(i, &p_.velocity[3 * i]), l = own(i, &p_.impulse[3 * i]);
    const dmat3 w = own_block(i);
    const double wn = w[0][0], wt = 0.5 * (w[1][1] + w[2][2]);
    double y = wt * l.y - u.y, z = wt * l.z - u.z;
    clamp_to_disc(y, z, mu(i) * wt * l.x);
    return std::max(std::abs(std::min(wn * l.x, u.x)), length2(wt * l.y - y, wt * l.z - z));
  }

  ContactProblem& p_;
  int rows_;
  std::ptrdiff_t stride_;
  bool turned_;             // contacts have axes of their own
  double immovable_ = 0.0;  // [1/kg]
};

}  // namespace

dmat3 leaning_axes(dvec2 lean) {
  const dvec3 n = normalize(dvec3(1.0, lean));
  const dvec3 t = normalize(dvec3(0.0, 1.0, 0.0) - n.y * n);
  return dmat3(n, t, cross(n, t));
}

void ContactProblem::resize(int contacts) {
  count = contacts;
  const Eigen::Index rows = 3 * contacts;
  if (W.rows() < rows) W.resize(rows, rows);
  for (Vector* v : {&bias, &impulse, &velocity})
    if (v->size() < rows) v->resize(rows);
  const std::size_t size = static_cast<std::size_t>(contacts);
  if (mu_static.size() < size) mu_static.resize(size);
  if (mu_sliding.size() < size) mu_sliding.resize(size);
  if (sliding.size() < size) sliding.resize(size);
}

SweepReport solve(ContactProblem& problem, const SweepLimits& limits) {
  const Eigen::Index rows = 3 * problem.count;
  const std::size_t count = static_cast<std::size_t>(problem.count);
  ASSERT(problem.W.rows() >= rows && problem.W.cols() >= rows && problem.bias.size() >= rows);
  ASSERT(problem.impulse.size() >= rows && problem.sliding.size() >= count && problem.mu_static.size() >= count &&
         problem.mu_sliding.size() >= count);
  if (problem.velocity.size() < rows) problem.velocity.resize(rows);
  SweepReport report;
  if (problem.count == 0) return report;

  const std::uint64_t begin = limits.budget_ns ? now_ns() : 0;
  const double enough = limits.tolerance * fastest(problem);
  Sweeper sweeper(problem);
  sweeper.start();
  report.residual = sweeper.residual();
  const int half = (limits.sweeps + 1) / 2;
  while (true) {
    const bool settled = report.residual <= enough;
    const int begun = settled || report.sweeps == half ? sweeper.begin_slips(10.0 * report.residual + enough) : 0;
    if (settled && begun == 0) break;
    if (report.sweeps == limits.sweeps) break;
    if (limits.budget_ns && now_ns() - begin >= limits.budget_ns) {
      report.in_time = false;
      break;
    }
    sweeper.sweep();
    ++report.sweeps;
    report.residual = sweeper.residual();
  }
  sweeper.begin_slips(10.0 * report.residual + enough);
  sweeper.end_slips();
  return report;
}

}  // namespace pliant
