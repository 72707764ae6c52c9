#include "systems/soft/contact/contact_admm.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>

namespace pliant {
namespace {

constexpr double kRelax = 1.6;     // [1] over-relaxation factor
constexpr double kFirstRho = 0.1;  // [1] of the mean diagonal of a contact's block
constexpr int kBalance = 50;       // iterations between changes of rho
constexpr double kBalanced = 10.0, kBalanceBy = 3.0;

// The point of the cone |t| <= mu n nearest to (n, t).
Eigen::Vector3d onto_cone(const Eigen::Vector3d& v, double mu) {
  const double t = std::hypot(v[1], v[2]);
  if (t <= mu * v[0]) return v;
  if (mu * t <= -v[0]) return Eigen::Vector3d::Zero();
  const double n = (v[0] + mu * t) / (1.0 + mu * mu), share = t > 0.0 ? mu * n / t : 0.0;
  return {n, share * v[1], share * v[2]};
}

struct Admm {
  ContactSweeps& sweeps;
  const Eigen::Index rows = 3 * sweeps.problem().count;
  Eigen::SparseMatrix<double> W{rows, rows};  // in the contacts' axes
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor;
  Vector scale = Vector::Zero(rows);                     // [1/kg] a contact's factor of rho
  Vector bias = scale, u = scale, x = scale, z = scale;  // [m/s], [N s]
  Vector s = scale;                                      // [N s] scaled dual variable
  double rho = kFirstRho;

  int count() const { return sweeps.problem().count; }
  void read(const Vector& from, Vector& to) const {
    for (int i = 0; i < count(); ++i) {
      const dvec3 own = sweeps.to_own(i, &from[3 * i]);
      for (int k = 0; k < 3; ++k) to[3 * i + k] = own[k];
    }
  }

  // False: the factorisation would cost more than `work` multiplications.
  bool fill(double work) {
    std::vector<Eigen::Triplet<double>> entries;
    Vector column(rows), own(rows);
    double cost = 0.0;
    for (int i = 0; i < count(); ++i)
      for (int k = 0; k < 3; ++k) {
        column.setZero();
        sweeps.add_columns(i, sweeps.from_own(i, dmat3(1.0)[k]), column.data());
        read(column, own);
        const std::size_t before = entries.size();
        for (Eigen::Index r = 0; r < rows; ++r)
          if (own[r] != 0.0) entries.emplace_back(static_cast<int>(r), 3 * i + k, own[r]);
        const double held = static_cast<double>(entries.size() - before);
        cost += held * held;
        if (cost > work) return false;
      }
    W.setFromTriplets(entries.begin(), entries.end());
    for (int i = 0; i < count(); ++i) scale.segment<3>(3 * i).setConstant(W.diagonal().segment<3>(3 * i).sum() / 3.0);
    scale = scale.cwiseMax(1e-9 * scale.maxCoeff());  // contacts that cannot be pushed
    return scale.minCoeff() > 0.0;
  }
  bool factorise() {
    Eigen::SparseMatrix<double> A = W;
    for (Eigen::Index r = 0; r < rows; ++r) A.coeffRef(r, r) += rho * scale[r];
    factor.compute(A);
    return factor.info() == Eigen::Success;
  }

  // Shift of the normal velocity by Coulomb's law.
  double shift(int i) const { return sweeps.mu(i) * std::hypot(u[3 * i + 1], u[3 * i + 2]); }
  void start() {
    read(sweeps.problem().bias, bias);
    read(sweeps.problem().impulse, z);
    read(sweeps.problem().velocity, u);
    for (int i = 0; i < count(); ++i) {
      s.segment<3>(3 * i) = -u.segment<3>(3 * i) / (rho * scale[3 * i]);
      s[3 * i] -= shift(i) / (rho * scale[3 * i]);
    }
  }
  // The allowed impulse nearest to `v`.
  Eigen::Vector3d allowed(int i, Eigen::Vector3d v) const {
    if (!sweeps.held(i)) return onto_cone(v, sweeps.mu(i));
    v[0] = sweeps.bounded(i, v[0]);
    for (int k = 0; k < 3; ++k) v[k] *= sweeps.holds(i, k);
    return v;
  }
  // Returns the residuals [m/s]: x against z, and z against the previous z.
  dvec2 iterate() {
    Vector right = rho * scale.cwiseProduct(z - s) - bias;
    for (int i = 0; i < count(); ++i) right[3 * i] -= shift(i);
    x = factor.solve(right);
    u = right - rho * scale.cwiseProduct(x) + bias;
    const Vector before = z, relaxed = kRelax * x + (1.0 - kRelax) * z;
    for (int i = 0; i < count(); ++i)
      z.segment<3>(3 * i) = sweeps.movable(i) ? allowed(i, relaxed.segment<3>(3 * i) + s.segment<3>(3 * i))
                                              : Eigen::Vector3d(Eigen::Vector3d::Zero());
    s += relaxed - z;
    return {scale.cwiseProduct(x - z).cwiseAbs().maxCoeff(),
            rho * scale.cwiseProduct(z - before).cwiseAbs().maxCoeff()};
  }
  bool balance(dvec2 left) {
    const double by = left.x > kBalanced * left.y ? kBalanceBy : left.y > kBalanced * left.x ? 1.0 / kBalanceBy : 1.0;
    if (by == 1.0) return true;
    rho *= by, s /= by;
    return factorise();
  }
};

}  // namespace

double improve_by_admm(ContactSweeps& sweeps, double residual, double enough, const AdmmLimits& limits,
                       int& iterations) {
  ContactProblem& p = sweeps.problem();
  Admm admm{sweeps};
  if (!admm.fill(limits.work) || !admm.factorise()) return residual;
  admm.start();
  while (iterations < limits.iterations) {
    const dvec2 left = admm.iterate();
    ++iterations;
    if (std::max(left.x, left.y) < enough) break;
    if (iterations % kBalance == 0 && !admm.balance(left)) break;
  }
  const Vector impulse = p.impulse.head(admm.rows), velocity = p.velocity.head(admm.rows);
  for (int i = 0; i < p.count; ++i) sweeps.set_impulse(i, {admm.z[3 * i], admm.z[3 * i + 1], admm.z[3 * i + 2]});
  sweeps.refresh_velocity();
  const double now = sweeps.residual();
  if (now < residual) return now;
  p.impulse.head(admm.rows) = impulse, p.velocity.head(admm.rows) = velocity;
  return residual;
}

}  // namespace pliant
