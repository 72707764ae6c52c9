#include "devices/servo/local_force.h"

#include <algorithm>
#include <cmath>

#include "devices/guard/turn_between.h"

namespace pliant {
namespace {

// The part of `v` against `direction` is left out.
dvec3 not_against(dvec3 v, dvec3 direction) {
  const double square = dot(direction, direction);
  return square > 0.0 ? v - std::min(0.0, dot(v, direction) / square) * direction : v;
}

double norm(const dmat3& m) {
  return std::sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2]));
}

}  // namespace

DeviceWrench local_force(const DeviceModel& model, dvec3 position, dquat rotation, dvec3 velocity, dvec3 spin,
                         double since) {
  const dvec3 way = position - model.position - since * model.velocity;
  const dvec3 turn = turn_between(model.rotation, rotation);
  DeviceWrench out = model.wrench;
  out.force += model.force_by_position * way + model.force_by_turn * turn +
               model.force_by_velocity * (velocity - model.velocity);
  out.torque += model.torque_by_position * way + model.torque_by_turn * turn + model.torque_by_spin * spin;
  out.force = not_against(out.force, model.wrench.force);
  return out;
}

bool is_nothing(const DeviceModel& model) {
  const double size = dot(model.wrench.force, model.wrench.force) + dot(model.wrench.torque, model.wrench.torque) +
                      norm(model.force_by_position) + norm(model.force_by_turn) + norm(model.torque_by_position) +
                      norm(model.torque_by_turn) + norm(model.force_by_velocity) + norm(model.torque_by_spin);
  return size == 0.0 && model.wrench.grip == 0.0;
}

// By its Frobenius norm over the square root of its rank's bound it would be too soft; by its largest row sum it is at
// least as stiff as its largest eigenvalue.
DeviceModel softened(const DeviceModel& model, double most) {
  if (!(most > 0.0)) return model;
  double largest = 0.0;
  for (int row = 0; row < 3; ++row) {
    double sum = 0.0;
    for (int column = 0; column < 3; ++column) sum += std::abs(model.force_by_position[column][row]);
    largest = std::max(largest, sum);
  }
  DeviceModel out = model;
  if (largest > most) out.force_by_position *= most / largest;
  return out;
}

}  // namespace pliant
