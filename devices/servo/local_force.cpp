#include "devices/servo/local_force.h"

#include <algorithm>
#include <cmath>

#include "devices/guard/guard.h"
#include "devices/guard/turn_between.h"

namespace pliant {
namespace {

// Removes the part of `v` that is opposite to `direction`.
dvec3 not_against(dvec3 v, dvec3 direction) {
  const double square = dot(direction, direction);
  return square > 0.0 ? v - std::min(0.0, dot(v, direction) / square) * direction : v;
}

double norm(const dmat3& m) {
  return std::sqrt(dot(m[0], m[0]) + dot(m[1], m[1]) + dot(m[2], m[2]));
}

constexpr double kSinglePrecision = 1.0 - 1e-5;  // [1] of a limit: allows for rounding to single precision when sent

// [N/m] The largest change of force per metre in any direction: for a symmetric matrix its largest eigenvalue, from
// above within rounding.
double steepest(const dmat3& m) {
  const double whole = norm(m);
  if (!(whole > 0.0)) return 0.0;
  dmat3 power = m / whole;
  double size = whole;
  // norm(m^n)^(1/n): to a thousandth with n = 1024.
  double root = 1.0;
  for (int i = 0; i < 10; ++i) {
    power = power * power;
    const double n = norm(power);
    root *= 0.5;
    size *= std::pow(n, root);
    power /= n;
  }
  return std::min(whole, size);
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

// The Frobenius norm would make it too soft. The largest row sum is an upper bound of the largest eigenvalue.
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

double stiffness_along(const dmat3& by_position, dvec3 wanted) {
  const double square = dot(wanted, wanted);
  return square > 0.0 ? std::max(0.0, -dot(wanted, by_position * wanted) / square) : 0.0;
}

double model_radius(const DeviceModel& model, double most) {
  const double slope = steepest(model.force_by_position), size = length(model.wrench.force);
  const double room = std::max(0.0, (most > 0.0 ? most : std::max(kUsualForce, size)) - size);
  if (!(slope > 0.0)) return kFarthestModel;
  return std::min(kFarthestModel, room / slope);
}

DeviceModel rendered_elsewhere(const DeviceModel& model, const DeviceWrench& sent, double share, double most) {
  DeviceModel out;
  out.position = model.position;
  out.rotation = model.rotation;
  out.wrench = sent;
  out.time = model.time;
  const double size = length(sent.force);
  const bool moves = dot(model.velocity, model.velocity) > 0.0 || norm(model.torque_by_turn) > 0.0;
  out.max_force = kSinglePrecision * (most > 0.0 ? most : std::max(kUsualForce, size));
  out.max_torque = model.max_torque;
  if (size > out.max_force) out.wrench.force *= out.max_force / size;
  if (moves || !(size > 0.0)) return out;
  // A working point at about half of the limit, so that the force can rise to the limit or fall to zero, but not
  // reverse: as far along the force from the device's position as the slope requires.
  const dvec3 along = sent.force / size;
  const dmat3 slope = share * model.force_by_position;
  const double steep = -dot(along, slope * along);
  if (!(steep > 0.0)) return out;
  const double off = (size - 0.5 * out.max_force) / steep;
  for (const dmat3& by_position : {slope, -steep * glm::outerProduct(along, along)}) {
    out.force_by_position = by_position;
    out.position = model.position + off * along;
    out.wrench.force = sent.force + off * (by_position * along);
    const bool halfway = length(out.wrench.force) > 0.499 * out.max_force;
    if (halfway && std::abs(off) <= model_radius(out, out.max_force)) break;
  }
  return out;
}

}  // namespace pliant
