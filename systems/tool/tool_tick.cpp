#include "systems/tool/tool_tick.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "systems/soft/linear/add_three.h"

namespace pliant {
namespace {

constexpr double kAnywhere = 1e9;    // [m] reach of a contact that has touched: it continues to slide
constexpr double kGone = 1.0;        // [m] gap of a contact that cannot close any more
constexpr double kMostTurned = 0.5;  // [1] tangent: largest tilt of a normal between two models

// A contact's axes after a slip, in the model's axes: the normal has rotated with the surfaces' curvature.
dmat3 turned_axes(dvec2 lean, const dmat2& turning, dvec2 slip) {
  lean += turning * slip;
  const double size = length(lean);
  if (size > kMostTurned) lean *= kMostTurned / size;
  return leaning_axes(lean);
}

// w = A^-1 b, or prescribed. A: effective inertia of the handle over one tick.
Vector6 free_twist(const Eigen::LLT<Matrix6>& factor, const TickHandle& handle, const Vector6& tissue_right) {
  return handle.moved ? handle.next : Vector6(factor.solve(handle.right + tissue_right));
}

const double* modes_at(const Rows& m, Eigen::Index row) {
  return m.data() + row * m.outerStride();
}

// [1] Tilt of a contact's normal by deformation: the derivative of its normal displacement by slip, for the
// displacements of modes and handle. Without it a hand could gain work by sliding one way while it presses and back
// while it does not.
dvec2 bent(const CondensedContacts& model, const CondensedState& state, int i) {
  dvec2 lean(0.0);
  for (int k = 0; k < 2; ++k) {
    const auto at = static_cast<std::size_t>(k);
    rows_times(modes_at(model.from_modes_by_slip[at], 3 * i), 0, 1, model.modes, state.q.data(), &lean[k]);
    lean[k] += model.from_handle_by_slip[at].row(3 * i).dot(state.d);
  }
  return lean;
}

// First-order change of the contacts' Jacobians with slip. Adds its part of the last impulses to modes and handle, and
// computes its part of the contacts' velocities. It is one tick late, so that the contacts' compliance stays
// precomputed.
void slide(const CondensedContacts& model, CondensedState& state, const Vector6& w, Vector& on_modes,
           Vector6& on_handle) {
  for (int i = 0; i < model.count; ++i) {
    const auto c = static_cast<std::size_t>(i);
    const auto impulse = state.problem.impulse.segment<3>(3 * i);
    state.shift[c] = dvec3(0.0);
    if (!(impulse[0] > 0.0) || model.held[c] != 0) continue;
    const double size = length(state.slip[c]);
    const dvec2 slip = size > model.farthest[c] ? model.farthest[c] / size * state.slip[c] : state.slip[c];
    const Rows &by_0 = model.from_modes_by_slip[0], &by_1 = model.from_modes_by_slip[1];
    add_three_rows({modes_at(by_0, 3 * i), modes_at(by_1, 3 * i), by_0.outerStride(), slip.x, slip.y}, model.modes,
                   state.rate.data(), impulse.data(), &state.shift[c].x, on_modes.data());
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Index row = 3 * i + axis;
      const auto of_handle =
          slip.x * model.from_handle_by_slip[0].row(row) + slip.y * model.from_handle_by_slip[1].row(row);
      state.shift[c][axis] += of_handle.dot(w);
      on_handle += impulse[axis] * of_handle.transpose();
    }
  }
}

// Contact velocities without new impulses, plus the rate that closes the remaining gap.
void fill_bias(const CondensedContacts& model, const CondensedState& state, const Vector6& w, Vector& bias) {
  const Eigen::Index rows = 3 * model.count;
  const double tick = model.tick;
  rows_times(model.from_modes.data(), model.from_modes.outerStride(), static_cast<int>(rows), model.modes,
             state.free_rate.data(), bias.data());
  bias.head(rows).noalias() += model.reduced_handle.topRows(rows) * w;
  bias.head(rows) -= state.spring.head(rows) / (tick + model.flexibility_lag);
  bias.head(rows) += model.drift.head(rows);
  for (int i = 0; i < model.count; ++i) {
    const double rate = state.gap[i] / tick;
    const dvec3 normal = state.problem.own[static_cast<std::size_t>(i)][0];
    const double closing = state.gap[i] >= 0.0 ? rate : std::max(rate, model.push[i]);
    for (int k = 0; k < 3; ++k) bias[3 * i + k] += closing * normal[k] + state.shift[static_cast<std::size_t>(i)][k];
  }
}

// W = delassus + R S^-1 R^T, R = reduced_handle: the second term is the handle's compliance. It is not added up: that
// took longer than solving.
void set_delassus(const CondensedContacts& model, const Eigen::LLT<Matrix6>& factor, const TickHandle& handle,
                  CondensedState& state) {
  const Eigen::Index rows = 3 * model.count;
  state.problem.shared = &model.delassus;
  state.problem.lever = nullptr;
  if (handle.moved) return;
  const Matrix6 lower = factor.matrixL().solve(Matrix6::Identity());
  state.lever.topRows(rows).noalias() = model.reduced_handle.topRows(rows).lazyProduct(lower.transpose());
  state.problem.lever = &state.lever;
}

// x += T v of all that moves.
void advance(const CondensedContacts& model, CondensedState& state, const TickHandle& handle, const Vector& lambda) {
  const Eigen::Index rows = 3 * model.count, modes = model.modes;
  const double tick = model.tick;
  state.q.head(modes) += tick * state.rate.head(modes);
  state.d += tick * handle.velocity;
  auto moved = state.free_rate.head(rows);  // of the contacts: first of the springs, then with modes and handle
  moved.setZero();
  add_columns(moved.data(), model.flexibility.data(), model.flexibility.outerStride(), static_cast<int>(rows),
              lambda.data(), static_cast<int>(rows));
  moved = (moved / tick - state.spring.head(rows)) / (tick + model.flexibility_lag);
  state.spring.head(rows) += tick * moved;
  auto with_modes = state.moved.head(rows);
  rows_times(model.from_modes.data(), model.from_modes.outerStride(), static_cast<int>(rows), static_cast<int>(modes),
             state.rate.data(), with_modes.data());
  moved += with_modes + model.drift.head(rows);
  moved.noalias() += model.from_handle.topRows(rows).lazyProduct(handle.velocity);
  for (int i = 0; i < model.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const dvec3 u = (dvec3(moved[3 * i], moved[3 * i + 1], moved[3 * i + 2]) + state.shift[k]) * state.problem.own[k];
    state.slip[k] += tick * dvec2(u.y, u.z);
    const double before = state.gap[i], after = before + tick * u.x;
    if (model.held[k] != 0) {
      // A bounded drive follows its bodies: `moved` has its spring's part, which its force does not say at the bound.
      if (model.most[k] < HUGE_VAL) state.spring[3 * i] -= tick * u.x;
      continue;
    }
    state.gap[i] = before >= 0.0 ? std::max(after, 0.0) : after;  // a gap closed up to rounding is closed
    if (lambda[3 * i] > 0.0) state.reach[k] = kAnywhere;
    if (state.gap[i] > 0.0 && length(state.slip[k]) > state.reach[k]) state.gap[i] = kGone;
  }
}

}  // namespace

Vector6 linear_tick(const LinearModel& model, const Vector6& w0, const Vector6& d, double tick, TickHandle& handle) {
  // (M_h + M + tick B + tick^2 K) w = right + M w_before + tick (force - K d + B w0): methods.md 2.7.
  const Vector6 before = handle.velocity;
  const Matrix6 tissue = model.mass + tick * model.damping + tick * tick * model.stiffness;
  const Vector6 right = model.mass * before + tick * (model.force - model.stiffness * d + model.damping * w0);
  Eigen::LLT<Matrix6> factor;
  if (!handle.moved) factor.compute(handle.inertia + tissue);
  handle.velocity = free_twist(factor, handle, right);
  return (right - tissue * handle.velocity) / tick;
}

void CondensedState::resize(int most_contacts, int most_modes) {
  const Eigen::Index rows = 3 * most_contacts;
  q.setZero(most_modes);
  rate.setZero(most_modes);
  free_rate.setZero(std::max<Eigen::Index>(most_modes, rows));
  moved.setZero(rows);
  spring.setZero(rows);
  gap.setZero(most_contacts);
  reach.assign(static_cast<std::size_t>(most_contacts), 0.0);
  slip.assign(static_cast<std::size_t>(most_contacts), dvec2(0.0));
  shift.assign(static_cast<std::size_t>(most_contacts), dvec3(0.0));
  lever.setZero(rows, 6);
  problem.resize_vectors(most_contacts);
  problem.own.assign(static_cast<std::size_t>(most_contacts), dmat3(1.0));
  problem.held.assign(static_cast<std::size_t>(most_contacts), 0);
  problem.most.assign(static_cast<std::size_t>(most_contacts), HUGE_VAL);
  problem.count = 0;
  key.assign(static_cast<std::size_t>(most_contacts), 0);
  last.setZero(rows);
}

void CondensedState::start(const CondensedContacts& model) {
  const Eigen::Index rows = 3 * model.count, modes = model.modes;
  const auto known = key.begin() + problem.count;
  last.head(3 * problem.count) = problem.impulse.head(3 * problem.count);
  q.head(modes).setZero();
  rate.head(modes) = model.rate.head(modes);
  d.setZero();
  spring.head(rows).setZero();
  add_columns(spring.data(), model.flexibility.data(), model.flexibility.outerStride(), static_cast<int>(rows),
              model.force.data(), static_cast<int>(rows));
  for (int i = 0; i < model.count; ++i)  // beyond its bound a drive stretches on
    if (const auto c = static_cast<std::size_t>(i); model.most[c] < HUGE_VAL)
      spring[3 * i] += model.flexibility(3 * i, 3 * i) * (model.unbounded[c] - model.force[3 * i]);
  gap.head(model.count) = model.gap.head(model.count);
  std::copy_n(model.slip.begin(), model.count, slip.begin());
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.count); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const bool touches = model.force[3 * row] > 0.0 || model.gap[row] <= 0.0;
    reach[i] = touches ? kAnywhere : model.reach[i];
  }
  problem.count = model.count;
  problem.impulse.head(rows) = model.tick * model.force.head(rows);
  for (int i = 0; i < model.count; ++i) {
    const auto c = static_cast<std::size_t>(i);
    if (!model.stiff[c]) continue;
    const auto before = std::find(key.begin(), known, model.key[c]);
    if (before == known) continue;
    const auto known_impulse = last.segment<3>(3 * (before - key.begin()));
    if (known_impulse.allFinite()) problem.impulse.segment<3>(3 * i) = model.tick / tick * known_impulse;
  }
  std::copy_n(model.key.begin(), model.count, key.begin());
  tick = model.tick;
  std::copy_n(model.mu_static.begin(), model.count, problem.mu_static.begin());
  std::copy_n(model.mu_sliding.begin(), model.count, problem.mu_sliding.begin());
  std::copy_n(model.sliding.begin(), model.count, problem.sliding.begin());
  std::copy_n(model.held.begin(), model.count, problem.held.begin());
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.count); ++i) problem.most[i] = model.tick * model.most[i];
}

Vector6 condensed_tick(const CondensedContacts& model, CondensedState& state, const SweepLimits& limits,
                       TickHandle& handle) {
  const Eigen::Index rows = 3 * model.count, modes = model.modes;
  const double tick = model.tick;
  const Vector6 before = handle.velocity;
  auto rate = state.rate.head(modes), free = state.free_rate.head(modes);

  // Right-hand sides of modes and handle: momentum and forces at the tick's beginning.
  Vector6 right = model.tissue_mass * before + tick * (model.tissue_force - model.tissue_stiffness * state.d);
  right.noalias() += model.modal_mass.topRows(modes).transpose().lazyProduct(rate);
  right.noalias() -= tick * model.modal_stiffness.topRows(modes).transpose().lazyProduct(state.q.head(modes));
  free = rate + tick * (model.load.head(modes) - model.frequency2.head(modes).cwiseProduct(state.q.head(modes)));
  slide(model, state, before, state.free_rate, right);
  free.noalias() += model.modal_mass.topRows(modes).lazyProduct(before);
  free.noalias() -= tick * model.modal_stiffness.topRows(modes).lazyProduct(state.d);
  free.array() *= model.inverse.head(modes).array();

  // The handle without new impulses, modes eliminated.
  const Vector6 reduced_right = right - model.border.topRows(modes).transpose().lazyProduct(free);
  Eigen::LLT<Matrix6> factor;
  if (!handle.moved) factor.compute(handle.inertia + model.reduced);
  const Vector6 free_w = free_twist(factor, handle, reduced_right);

  // Signorini and Coulomb again.
  for (std::size_t i = 0; i < static_cast<std::size_t>(model.count); ++i)
    state.problem.own[i] =
        turned_axes(model.lean[i] + bent(model, state, static_cast<int>(i)), model.turning[i], state.slip[i]);
  set_delassus(model, factor, handle, state);
  fill_bias(model, state, free_w, state.problem.bias);
  state.report = solve(state.problem, limits);
  const Vector& lambda = state.problem.impulse;

  // Effect of the impulses on handle and modes.
  handle.velocity = free_w;
  if (!handle.moved)
    handle.velocity +=
        factor.solve(Vector6(model.reduced_handle.topRows(rows).transpose().lazyProduct(lambda.head(rows))));
  rate.setZero();
  add_rows(model.from_modes.data(), model.from_modes.outerStride(), static_cast<int>(rows), static_cast<int>(modes),
           lambda.data(), rate.data());
  rate.noalias() -= model.border.topRows(modes).lazyProduct(handle.velocity);
  rate.array() *= model.inverse.head(modes).array();
  rate += free;

  Vector6 impulse = right;
  const double tick2 = tick * tick;
  impulse -= (model.tissue_mass + tick * model.tissue_damping + tick2 * model.tissue_stiffness) * handle.velocity;
  impulse.noalias() -= model.border.topRows(modes).transpose().lazyProduct(rate);
  impulse.noalias() += model.from_handle.topRows(rows).transpose().lazyProduct(lambda.head(rows));
  advance(model, state, handle, lambda);
  return impulse / tick;
}

}  // namespace pliant
