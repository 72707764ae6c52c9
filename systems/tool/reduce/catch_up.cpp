#include "systems/tool/reduce/catch_up.h"

#include <algorithm>
#include <cmath>

#include "systems/soft/body/rotation_vector.h"

namespace pliant {
namespace {

constexpr SweepLimits kAgain{100, 1e-4, 0};
constexpr double kFree = 1e-6;      // [1] (T omega)^2 of motion without elastic force
constexpr double kRidge = 1e-9;     // [1] of the largest compliance: redundant contacts
constexpr double kOwedSteps = 2.0;  // [1] of bodies as heavy as the hand; over fewer the handle leaves a heavy one
constexpr double kMassless = 1e-2;  // [1] of such motion's inertia

// [1/kg] `W` with bodies that move freely almost without inertia. They follow the handle's displacement, and no force
// accelerates them: nothing would take it back, and a load below a light tool would fly instead of hang.
Eigen::MatrixXd quasi_static(const CondensedContacts& c, const Eigen::MatrixXd& W, double T) {
  Eigen::MatrixXd out = W;
  const Eigen::Index rows = 3 * c.count;
  for (Eigen::Index k = 0; k < c.modes; ++k) {
    if (T * T * c.frequency2[k] > kFree) continue;
    const auto mode = c.from_modes.col(k).head(rows);
    out.topLeftCorner(rows, rows) += (1 / kMassless - 1) / (1.0 + T * c.damping[k]) * mode * mode.transpose();
  }
  return out;
}

// Of what resists a displacement `left` of the handle, the part of bodies that move freely: by their inertia. Of
// open contacts too: the hand is also owed what it gave in contacts that the step found open.
void set_owed(const Eigen::MatrixXd& W, const Eigen::MatrixXd& free, const Vector6& left, const Matrix6& impedance,
              HandleModel& model) {
  const CondensedContacts& c = model.contacts;
  std::vector<Eigen::Index> rows;
  for (int i = 0; i < c.count; ++i)
    for (int k = 0; k < 3; ++k)
      if (const auto at = static_cast<std::size_t>(i); c.held[at] == 0 ? k == 0 : (c.held[at] >> k & 1) != 0)
        if (!c.stiff[at]) rows.push_back(3 * i + k);
  if (rows.empty()) return;
  const Vector way = (c.from_handle * left)(rows);
  const auto resistance = [&](const Eigen::MatrixXd& compliance) {
    Eigen::MatrixXd of = compliance(rows, rows);
    of.diagonal().array() += kRidge * of.diagonal().maxCoeff();
    return way.dot(of.llt().solve(way));
  };
  const double all = resistance(W), hand = left.dot(impedance * left);
  if (!(all > 0.0 && hand > 0.0)) return;
  const double T = model.soft_step, share = std::clamp(1.0 - resistance(free) / all, 0.0, 1.0);
  model.owed = -share / (T * T) * impedance * left;
  model.owed_steps = kOwedSteps * std::max(1.0, std::sqrt(share * all / hand));
}

// Solves the compliant contacts again, with the handle moving `extra` [m/s], [rad/s] faster over the step T [s].
// Updates impulses and velocities of all contacts.
void solve_again(const CondensedContacts& model, const Eigen::MatrixXd& W, const Vector6& extra, double T,
                 Vector& impulse, Vector& velocity, std::vector<std::uint8_t>& sliding) {
  std::vector<int> soft;
  for (int i = 0; i < model.count; ++i)
    if (!model.stiff[static_cast<std::size_t>(i)]) soft.push_back(i);
  const Vector moved = model.from_handle.topRows(velocity.size()) * extra;
  velocity += moved;
  if (soft.empty()) return;

  ContactProblem problem;
  problem.resize(static_cast<int>(soft.size()));
  for (std::size_t a = 0; a < soft.size(); ++a) {
    const Eigen::Index row = 3 * static_cast<Eigen::Index>(a), from = 3 * soft[a];
    const auto at = static_cast<std::size_t>(soft[a]);
    for (std::size_t b = 0; b < soft.size(); ++b)
      problem.W.block<3, 3>(row, 3 * static_cast<Eigen::Index>(b)) = W.block<3, 3>(from, 3 * soft[b]);
    problem.impulse.segment<3>(row) = impulse.segment<3>(from);
    problem.mu_static[a] = model.mu_static[at];
    problem.mu_sliding[a] = model.mu_sliding[at];
    problem.sliding[a] = sliding[at];
    problem.own.push_back(leaning_axes(model.lean[at]));
    problem.held.push_back(model.held[at]);
    problem.most.push_back(T * model.most[at]);
  }
  const Eigen::Index rows = 3 * static_cast<Eigen::Index>(soft.size());
  const Vector before = problem.impulse.head(rows);
  for (std::size_t a = 0; a < soft.size(); ++a)
    problem.bias.segment<3>(3 * static_cast<Eigen::Index>(a)) = velocity.segment<3>(3 * soft[a]);
  problem.bias.head(rows).noalias() -= problem.W.topLeftCorner(rows, rows) * before;
  solve(problem, kAgain);

  const Vector change = problem.impulse.head(rows) - before;
  for (std::size_t a = 0; a < soft.size(); ++a) {
    impulse.segment<3>(3 * soft[a]) += change.segment<3>(3 * static_cast<Eigen::Index>(a));
    velocity += W.middleCols<3>(3 * soft[a]) * change.segment<3>(3 * static_cast<Eigen::Index>(a));
    sliding[static_cast<std::size_t>(soft[a])] = problem.sliding[a];
  }
}

// Modes and tissue follow the handle's displacement and the change of contact impulses; the model's displacements stay
// zero at its new pose.
void move_along(const Vector6& left, const Vector& change, double T, HandleModel& model) {
  CondensedContacts& c = model.contacts;
  const Eigen::Index modes = c.modes, rows = 3 * c.count;
  const auto share = (1.0 + T * c.damping.head(modes).array() + T * T * c.frequency2.head(modes).array()).inverse();
  const Vector rate = share.matrix().cwiseProduct(c.from_modes.topLeftCorner(rows, modes).transpose() * change);
  const Vector q = T * rate;
  c.rate.head(modes) += (T * T * c.frequency2.head(modes).array() > kFree).select(rate, 0.0).matrix();
  c.tissue_force -= c.tissue_stiffness * left + c.modal_stiffness.topRows(modes).transpose() * q;
  c.load.head(modes) -= c.frequency2.head(modes).cwiseProduct(q) + c.modal_stiffness.topRows(modes) * left;
}

}  // namespace

Vector6 catch_up(const ToolContacts& contacts, const Vector6& left, const Eigen::MatrixXd& W, HandleModel& model) {
  model.owed.setZero();
  if (left.isZero(0.0)) return Vector6::Zero();
  CondensedContacts& c = model.contacts;
  const FinishedStep& step = contacts.step();
  const double T = step.T;
  const Eigen::Index rows = contacts.rows();
  const Vector before = T * c.force.head(rows);
  Vector velocity(rows);
  for (int i = 0; i < c.count; ++i)
    velocity.segment<3>(3 * i) = step.problem.velocity.segment<3>(3 * static_cast<Eigen::Index>(contacts.in_step(i)));
  const auto wrench_of = [&](const Vector& change) -> Vector6 {
    return c.from_handle.topRows(rows).transpose() * change / T;
  };

  const Eigen::MatrixXd free = quasi_static(c, W, T);
  Vector impulse = before;
  Vector6 by_inertia = Vector6::Zero();
  if (free != W) {
    Vector u = velocity;
    std::vector<std::uint8_t> sliding = c.sliding;
    solve_again(c, W, left / T, T, impulse, u, sliding);
    by_inertia = wrench_of(impulse - before);
    impulse = before;
  }
  solve_again(c, free, left / T, T, impulse, velocity, c.sliding);
  const Vector change = impulse - before;
  if (free != W) {
    by_inertia -= wrench_of(change);
    set_owed(W, free, left, contacts.tool().prescribed_impedance(), model);
  }
  move_along(left, change, T, model);
  for (int i = 0; i < c.count; ++i) {
    if (c.stiff[static_cast<std::size_t>(i)]) continue;
    const double *l = &impulse[3 * i], *u = &velocity[3 * i];
    set_solution(contacts, i, dvec3(l[0], l[1], l[2]), dvec3(u[0], u[1], u[2]), c);
  }
  model.force += wrench_of(change) - contacts.tool().tissue_matrix() * left / (T * T);
  model.handle.velocity += left / T;
  model.handle.pose.position += linear(left);
  model.handle.pose.rotation = glm::normalize(rotation_of(angular(left)) * model.handle.pose.rotation);
  return by_inertia;
}

}  // namespace pliant
